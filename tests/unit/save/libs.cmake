set(libs fathom_save-format fathom_typecheck)

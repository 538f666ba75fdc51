set(libs fathom_save-format fathom_typecheck fathom_driver fathom_cpu)

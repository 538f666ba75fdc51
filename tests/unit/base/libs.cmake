set(libs fathom_base)

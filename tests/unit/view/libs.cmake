set(libs fathom_ir)

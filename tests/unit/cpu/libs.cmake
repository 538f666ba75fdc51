set(libs fathom_cpu fathom_ir fathom_base)

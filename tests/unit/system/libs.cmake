set(libs fathom_system)

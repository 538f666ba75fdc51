set(libs fathom_gl)

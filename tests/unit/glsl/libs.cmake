set(libs fathom_glsl)

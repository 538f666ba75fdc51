set(libs fathom_driver fathom_glsl fathom_cpu)

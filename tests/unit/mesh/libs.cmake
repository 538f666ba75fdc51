set(libs fathom_mesh fathom_driver)

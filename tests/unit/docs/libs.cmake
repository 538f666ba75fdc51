set(libs fathom_driver)

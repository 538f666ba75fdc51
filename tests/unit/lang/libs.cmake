set(libs fathom_lang)

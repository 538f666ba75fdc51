set(libs fathom_lsp fathom_calls)

set(libs fathom_proof)

// The words of Fathom. Written by editors/make.py from `fathom doc --json`; do not change it here.
export const keywords = [@QUOTED(keywords)@];
export const types = [@QUOTED(types)@];
export const constants = [@QUOTED(constants)@];
export const colors = [@QUOTED(colors)@];
export const functions = [@QUOTED(functions)@];

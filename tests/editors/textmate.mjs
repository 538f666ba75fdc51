// What VS Code's grammar makes of each character (grammars.py): ROOT FILE… in the current folder.
import fs from "node:fs";
import {createRequire} from "node:module";

const require = createRequire(process.env.NODE_MODULES + "/");
const oniguruma = require("vscode-oniguruma");
const textmate = require("vscode-textmate");

const [root, ...files] = process.argv.slice(2);
await oniguruma.loadWASM(fs.readFileSync(process.env.NODE_MODULES + "/vscode-oniguruma/release/onig.wasm").buffer);
const registry = new textmate.Registry({
  onigLib: Promise.resolve({
    createOnigScanner: (patterns) => new oniguruma.OnigScanner(patterns),
    createOnigString: (text) => new oniguruma.OnigString(text),
  }),
  loadGrammar: async () => textmate.parseRawGrammar(
    fs.readFileSync(root + "/editors/vscode/syntaxes/fathom.tmLanguage.json", "utf8"), "fathom.json"),
});
const grammar = await registry.loadGrammar("source.fathom");
const classes = [
  ["comment", "c"], ["string", "s"], ["constant.numeric", "n"], ["constant.other.color", "n"],
  ["keyword.operator.fathom", "o"], ["keyword", "k"],
];
for (const file of files) {
  let marks = "", stack = textmate.INITIAL;
  const lines = fs.readFileSync(file, "utf8").split("\n");
  lines.forEach((line, i) => {
    const read = grammar.tokenizeLine(line, stack);
    stack = read.ruleStack;
    const row = Array(line.length).fill(".");
    for (const token of read.tokens) {
      const scope = token.scopes.at(-1);
      const found = classes.find(([prefix]) => scope.startsWith(prefix));
      if (found) row.fill(found[1], token.startIndex, Math.min(token.endIndex, line.length));
    }
    marks += row.join("") + (i + 1 < lines.length ? "." : "");
  });
  fs.writeFileSync(file + ".marks", marks);
}

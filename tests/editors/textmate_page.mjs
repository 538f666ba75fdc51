// A text as VS Code colours it, as a page: ROOT FILE. The colours are those of its theme Dark+.
import fs from "node:fs";
import {createRequire} from "node:module";

const require = createRequire(process.env.NODE_MODULES + "/");
const oniguruma = require("vscode-oniguruma");
const textmate = require("vscode-textmate");

const [root, file] = process.argv.slice(2);
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
const colors = [
  ["comment", "#6a9955"], ["string", "#ce9178"], ["constant.numeric", "#b5cea8"], ["constant.language", "#569cd6"],
  ["constant", "#4fc1ff"], ["keyword.operator", "#d4d4d4"], ["keyword.control", "#c586c0"], ["keyword", "#569cd6"],
  ["storage", "#569cd6"], ["entity.name.function", "#dcdcaa"], ["support.function", "#dcdcaa"],
  ["support.type", "#4ec9b0"], ["entity.name.type", "#4ec9b0"], ["variable", "#9cdcfe"], ["support.constant", "#4fc1ff"],
];
const escaped = (text) => text.replace(/&/g, "&amp;").replace(/</g, "&lt;");
let stack = textmate.INITIAL, page = "";
fs.readFileSync(file, "utf8").trimEnd().split("\n").forEach((line, i) => {
  const read = grammar.tokenizeLine(line, stack);
  stack = read.ruleStack;
  page += `<i>${String(i + 1).padStart(3)}</i>  `;
  for (const token of read.tokens) {
    const scope = token.scopes.at(-1), found = colors.find(([prefix]) => scope.startsWith(prefix));
    page += `<span style="color:${found ? found[1] : "#d4d4d4"}">${escaped(line.slice(token.startIndex, token.endIndex))}</span>`;
  }
  page += "\n";
});
console.log(`<!doctype html><meta charset="utf-8"><style>
body { margin: 0; background: #1e1e1e; color: #d4d4d4; }
pre { margin: 12px; font: 14px/21px "DejaVu Sans Mono", monospace; }
i { color: #858585; font-style: normal; }
</style><pre>${page}</pre>`);

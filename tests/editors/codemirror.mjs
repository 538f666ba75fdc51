// What the CodeMirror grammar makes of each character (grammars.py): ROOT FILE… in the current folder.
import fs from "node:fs";
import {createRequire} from "node:module";

const require = createRequire(process.env.NODE_MODULES + "/");
const {buildParser} = require("@lezer/generator");

const [root, ...files] = process.argv.slice(2);
const parser = buildParser(fs.readFileSync(root + "/editors/codemirror/fathom.grammar", "utf8"));
const classes = {
  LineComment: "c", BlockComment: "c", String: "s", Number: "n", Color: "n", Keyword: "k", As: "k", Truth: "k",
  Operator: "o",
};
let errors = 0;
for (const file of files) {
  const text = fs.readFileSync(file, "utf8");
  const marks = Array(text.length).fill(".");
  parser.parse(text).iterate({
    enter(node) {
      if (node.type.isError) ++errors;
      if (classes[node.name]) marks.fill(classes[node.name], node.from, node.to);
    },
  });
  fs.writeFileSync(file + ".marks", marks.join(""));
}
if (errors) {
  console.error(errors + " errors");
  process.exit(1);
}

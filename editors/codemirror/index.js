// Fathom for CodeMirror 6: `extensions: [fathom()]`. Colours, brackets, folding, indentation, comments,
// and completion of the library's names.
import {LanguageSupport, LRLanguage, continuedIndent, delimitedIndent, foldInside, foldNodeProp, indentNodeProp} from "@codemirror/language";
import {completeFromList} from "@codemirror/autocomplete";
import {styleTags, tags} from "@lezer/highlight";
import {parser} from "./parser.js";
import {colors, constants, functions, keywords, types} from "./words.js";

export const language = LRLanguage.define({
  name: "fathom",
  parser: parser.configure({
    props: [
      styleTags({
        Keyword: tags.keyword,
        As: tags.keyword,
        Truth: tags.bool,
        Name: tags.variableName,
        Member: tags.propertyName,
        Argument: tags.propertyName,
        Number: tags.number,
        Color: tags.color,
        String: tags.string,
        Operator: tags.operator,
        LineComment: tags.lineComment,
        BlockComment: tags.blockComment,
        "( )": tags.paren,
        "[ ]": tags.squareBracket,
        "{ }": tags.brace,
      }),
      indentNodeProp.add({
        Parentheses: delimitedIndent({closing: ")"}),
        List: delimitedIndent({closing: "]"}),
        Block: delimitedIndent({closing: "}"}),
        File: continuedIndent({except: /^\s*[^.|&\s]/}),
      }),
      foldNodeProp.add({Parentheses: foldInside, List: foldInside, Block: foldInside}),
    ],
  }),
  languageData: {
    commentTokens: {line: "//", block: {open: "/*", close: "*/"}},
    closeBrackets: {brackets: ["(", "[", "{", '"']},
  },
});

const options = (labels, type) => labels.map((label) => ({label, type}));
const words = [
  ...options(keywords, "keyword"), ...options(types, "type"), ...options(functions, "function"),
  ...options(constants, "constant"), ...options(colors, "constant"),
];

export function fathom() {
  return new LanguageSupport(language, language.data.of({autocomplete: completeFromList(words)}));
}

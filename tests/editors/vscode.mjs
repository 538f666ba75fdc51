// VS Code's extension with stand-ins for VS Code and its client: numbers that are dragged, and the page where
// no window opens. tests/editors/vscode.mjs EXTENSION. Says what is wrong, and ends with 1.
import assert from "node:assert";
import {createRequire} from "node:module";
import Module from "node:module";

const require = createRequire(import.meta.url);

class Position {
  constructor(line, character) { Object.assign(this, {line, character}); }
  isEqual(other) { return this.line === other.line && this.character === other.character; }
  translate(lines, characters) { return new Position(this.line + lines, this.character + characters); }
}
class Range {
  constructor(start, end) { Object.assign(this, {start, end}); }
}
class Document {
  constructor(text) {
    Object.assign(this, {lines: text.split("\n"), languageId: "fathom", fileName: "/scenes/a.sdf",
      uri: {scheme: "file", fsPath: "/scenes/a.sdf", toString: () => "file:///scenes/a.sdf"}});
  }
  getText(range) {
    return range ? this.lines[range.start.line].slice(range.start.character, range.end.character)
      : this.lines.join("\n");
  }
  getWordRangeAtPosition(at, pattern) {
    for (const match of this.lines[at.line].matchAll(new RegExp(pattern, "g")))
      if (match.index <= at.character && at.character <= match.index + match[0].length)
        return new Range(new Position(at.line, match.index), new Position(at.line, match.index + match[0].length));
    return undefined;
  }
}
const listeners = {}, commands = {}, notifications = {}, panels = [];
const disposable = {dispose() {}};
const vscode = {
  Position, Range, ViewColumn: {Beside: 2}, TaskScope: {Workspace: 1},
  TextEditorSelectionChangeKind: {Keyboard: 1, Mouse: 2, Command: 3},
  commands: {registerCommand: (name, run) => ((commands[name] = run), disposable)},
  tasks: {registerTaskProvider: () => disposable},
  workspace: {getConfiguration: () => ({get: () => "/nonexistent/fathom"}), onDidChangeTextDocument: () => disposable},
  window: {
    visibleTextEditors: [],
    onDidChangeTextEditorSelection: (hear) => ((listeners.selection = hear), disposable),
    showWarningMessage: (text) => (vscode.window.warned = text),
    createWebviewPanel: (kind) => {
      const panel = {kind, webview: {html: ""}, onDidDispose: () => disposable};
      panels.push(panel);
      return panel;
    },
  },
};
class LanguageClient {
  onNotification(name, hear) { notifications[name] = hear; return disposable; }
  isRunning() { return true; }
  sendNotification(name, said) { this.sent = {name, said}; }
  sendRequest() { return Promise.reject(new Error("no display")); }
  start() { return Promise.resolve(); }
  stop() {}
}
const load = Module._load;
Module._load = (name, ...rest) => name === "vscode" ? vscode
  : name === "vscode-languageclient/node" ? {LanguageClient} : load(name, ...rest);
const extension = require(process.argv[2]);
await extension.activate({subscriptions: []});

const document = new Document("param r = 0.50 in 0..2\nsphere(r)\nbox(12)");
const editor = {
  document, selection: {active: new Position(0, 12)},
  edit(change) {
    change({replace: (range, text) => {
      const line = document.lines[range.start.line];
      document.lines[range.start.line] = line.slice(0, range.start.character) + text + line.slice(range.end.character);
    }});
  },
};
vscode.window.activeTextEditor = editor;
vscode.window.visibleTextEditors.push(editor);

commands["fathom.slideUp"]();
assert.equal(document.lines[0], "param r = 0.51 in 0..2");
commands["fathom.slideDown"]();
assert.equal(document.lines[0], "param r = 0.50 in 0..2");

const at = (line, character) => new Position(line, character);
const cursor = {anchor: at(1, 0), active: at(1, 0)};
const select = (anchor, active, kind = 2, others = [cursor]) =>
  listeners.selection({textEditor: editor, kind, selections: [...others, {anchor, active}]});
select(at(0, 11), at(0, 11));
assert.equal(document.lines[0], "param r = 0.50 in 0..2"); // pressed, not yet moved
select(at(0, 11), at(0, 14));
assert.equal(document.lines[0], "param r = 0.53 in 0..2");
select(at(0, 11), at(0, 3));
assert.equal(document.lines[0], "param r = 0.42 in 0..2"); // counted from where it began
select(at(0, 11), at(1, 3));
assert.equal(document.lines[0], "param r = 0.42 in 0..2"); // off the line
select(at(2, 5), at(2, 5));
select(at(2, 5), at(2, 0)); // another number, which becomes shorter and longer
assert.equal(document.lines[2], "box(7)");
select(at(2, 5), at(2, 8));
assert.equal(document.lines[2], "box(15)");
select(at(2, 5), at(2, 0));
select(at(2, 5), at(2, 5));
assert.equal(document.lines[2], "box(12)");
select(at(1, 2), at(1, 5)); // no number there
assert.equal(document.lines[1], "sphere(r)");
select(at(0, 11), at(0, 14), 1); // by the keyboard
select(at(0, 11), at(0, 14), 2, []); // a selection without Alt
assert.equal(document.lines[0], "param r = 0.42 in 0..2");

assert.equal(panels.length, 0);
notifications["fathom/windowFailed"]({uri: "file:///scenes/other.sdf"});
assert.equal(panels.length, 0);
notifications["fathom/windowFailed"]({uri: "file:///scenes/a.sdf"});
assert.equal(panels.length, 1);
await commands["fathom.view"]();
await new Promise((done) => setTimeout(done, 200));
assert.match(vscode.window.warned, /no display/);
assert.equal(panels.length, 2);
assert.match(panels[1].webview.html, /ENOENT/); // the program is not there: the panel says so
console.log("vscode: the extension does as it should");

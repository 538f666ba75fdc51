// Fathom in VS Code: starts the language server, offers the program's commands as tasks, and shows
// the picture of a text beside it as the page that `fathom compile --target html` writes.
"use strict";
const vscode = require("vscode");
const path = require("path");
const {spawn} = require("child_process");
const {LanguageClient} = require("vscode-languageclient/node");

let client;

const program = () => vscode.workspace.getConfiguration("fathom").get("program");

// The page for a text, or what the compiler says against it.
function page(document) {
  return new Promise((resolve) => {
    const folder = document.uri.scheme === "file" ? path.dirname(document.uri.fsPath) : undefined;
    const child = spawn(program(), ["compile", "-", "--target", "html"], {cwd: folder});
    let out = "", said = "";
    child.stdout.on("data", (bytes) => (out += bytes));
    child.stderr.on("data", (bytes) => (said += bytes));
    child.on("error", (error) => resolve({said: String(error)}));
    child.on("close", (status) => resolve(status === 0 ? {html: out} : {said}));
    child.stdin.on("error", () => {}); // it ended before it read all: `close` tells
    child.stdin.end(document.getText());
  });
}

// A panel that follows a text. An error leaves the last good picture; the editor shows the error.
function showPicture(editor) {
  const document = editor.document;
  const panel = vscode.window.createWebviewPanel("fathom.picture", path.basename(document.fileName),
    {viewColumn: vscode.ViewColumn.Beside, preserveFocus: true}, {enableScripts: true});
  let newest = 0, timer;
  const draw = async () => {
    const mine = ++newest;
    const made = await page(document);
    if (mine !== newest) return;
    if (made.html) panel.webview.html = made.html;
    else if (!panel.webview.html) {
      const text = made.said.replace(/&/g, "&amp;").replace(/</g, "&lt;");
      panel.webview.html = `<!doctype html><pre>${text}</pre>`;
    }
  };
  const changes = vscode.workspace.onDidChangeTextDocument((event) => {
    if (event.document !== document) return;
    clearTimeout(timer);
    timer = setTimeout(draw, 200);
  });
  panel.onDidDispose(() => {
    ++newest;
    clearTimeout(timer);
    changes.dispose();
  });
  draw();
}

// The viewer's window, which follows the text as it is typed; where none can be opened, the page.
async function showWindow(editor) {
  try {
    await client.sendRequest("fathom/preview", {textDocument: {uri: editor.document.uri.toString()}});
  } catch (failed) {
    vscode.window.showWarningMessage(`Fathom: ${failed.message}`);
    showPicture(editor);
  }
}

const numberAt = (document, position) => document.getWordRangeAtPosition(position, /\d+(?:\.\d+)?/);

// A number's text, so many units of its last digit further.
function moved(number, steps) {
  const decimals = (number.split(".")[1] || "").length;
  return Math.max(Number(number) + steps * 10 ** -decimals, 0).toFixed(decimals);
}

function slide(editor, steps) {
  const range = numberAt(editor.document, editor.selection.active);
  if (range) editor.edit((edit) => edit.replace(range, moved(editor.document.getText(range), steps)));
}

// Alt-drag: where Alt adds cursors, pressing it on a number and moving the mouse makes a second selection
// that begins there. Each column to the right is one unit of the number's last digit more, to the left one
// less; the number as it stood when the drag began is what is counted from.
let drag = null; // {document, anchor, number, length, steps}, while there is one

function dragged(event) {
  const editor = event.textEditor, selections = event.selections, last = selections[selections.length - 1];
  if (event.kind !== vscode.TextEditorSelectionChangeKind.Mouse || selections.length < 2) {
    if (event.kind === vscode.TextEditorSelectionChangeKind.Mouse) drag = null;
    return;
  }
  if (!drag || drag.document !== editor.document || !drag.anchor.isEqual(last.anchor)) {
    const range = numberAt(editor.document, last.anchor);
    drag = range ? {document: editor.document, anchor: last.anchor, start: range.start, steps: 0,
      number: editor.document.getText(range), length: editor.document.getText(range).length} : null;
  }
  if (!drag || last.active.line !== drag.anchor.line) return;
  const steps = last.active.character - drag.anchor.character;
  if (steps === drag.steps) return;
  const value = moved(drag.number, steps);
  const range = new vscode.Range(drag.start, drag.start.translate(0, drag.length));
  drag.steps = steps;
  drag.length = value.length;
  editor.edit((edit) => edit.replace(range, value), {undoStopBefore: false, undoStopAfter: false});
}

function task(definition, file) {
  return new vscode.Task(definition, vscode.TaskScope.Workspace, definition.command, "fathom",
    new vscode.ProcessExecution(program(), [definition.command, file]), "$fathom");
}

const tasks = {
  provideTasks: () => ["check"].map((command) => task({type: "fathom", command}, "${file}")),
  resolveTask: (given) => task(given.definition, given.definition.file || "${file}"),
};

function activate(context) {
  client = new LanguageClient("fathom", "Fathom", {command: program(), args: ["lsp"]},
    {documentSelector: [{language: "fathom"}]});
  const withEditor = (work) => () => {
    const editor = vscode.window.activeTextEditor;
    if (editor && editor.document.languageId === "fathom") work(editor);
  };
  context.subscriptions.push(
    vscode.commands.registerCommand("fathom.picture", withEditor(showPicture)),
    vscode.commands.registerCommand("fathom.view", withEditor(showWindow)),
    vscode.commands.registerCommand("fathom.slideUp", withEditor((editor) => slide(editor, 1))),
    vscode.commands.registerCommand("fathom.slideDown", withEditor((editor) => slide(editor, -1))),
    client.onNotification("fathom/windowFailed", ({uri}) => {
      const editor = vscode.window.visibleTextEditors.find((one) => one.document.uri.toString() === uri);
      if (editor) showPicture(editor);
    }),
    vscode.window.onDidChangeTextEditorSelection((event) => {
      const document = event.textEditor.document;
      if (document.languageId === "fathom") dragged(event);
      if (document.languageId === "fathom" && client.isRunning())
        client.sendNotification("fathom/cursor", {textDocument: {uri: document.uri.toString()},
          position: event.selections[0].active});
    }),
    vscode.tasks.registerTaskProvider("fathom", tasks));
  return client.start();
}

const deactivate = () => client && client.stop();

module.exports = {activate, deactivate};

/** @file
 *  What an editor asks of texts as they are typed: what is wrong, what a name is, what may stand at a
 *  place, where a name stands, edits that keep the meaning. `fathom lsp` is made of it.
 *
 *  @code
 *  #include <fathom/language.h>
 *  #include <cstdio>
 *
 *  int main() {
 *      fathom::Workspace workspace;
 *      const std::string text = "let radius = 1.5\nsphere(rad)\n"; // half-typed
 *      workspace.set_text("ball.sdf", text);
 *      for (const fathom::Diagnostic &d : workspace.diagnostics("ball.sdf").value)
 *          std::printf("%d: %s\n", d.at.line, d.message.c_str());
 *      for (const fathom::CompletionItem &item : workspace.completion("ball.sdf", 27).value)
 *          if (item.label == "radius") std::printf("%s: %s\n", item.label.c_str(), item.detail.c_str());
 *      workspace.set_text("ball.sdf", "let radius = 1.5\nsphere(radius)\n");
 *      const auto edits = workspace.rename("ball.sdf", 5, "r");
 *      if (!edits) return 1;
 *      std::printf("%zu edits\n", edits.value.at("ball.sdf").size());
 *      return edits.value.at("ball.sdf").size() == 2 ? 0 : 1;
 *  }
 *  @endcode
 */
#pragma once

#include <fathom/explain.h>

#include <utility>

namespace fathom::FATHOM_V1 {

/** Bytes of a text, from `begin` up to `end`, which is one past the last. */
struct Stretch {
    std::size_t begin = 0, end = 0;
};

/** A stretch of the text at a path; with `library`, of the file of that name in `library_texts()`. */
struct Location {
    std::string path;
    Stretch at;
    bool library = false;
};

/** A replacement of a stretch; an insertion where that is empty. */
struct TextEdit {
    Stretch at;
    std::string text;
};
/** Edits by path. Those of one text do not overlap, and are all of the text as it is. */
using WorkspaceEdit = std::map<std::string, std::vector<TextEdit>>;

/** How a question ended: with an answer; the text is not open; it cannot be done, and `why` is for
 *  the user; nobody waits for it any more (Workspace::set_outdated); a lack of memory, or a fault of
 *  ours. */
enum class Outcome { Answered, NotOpen, Refused, Outdated, Failed };

/** What was asked for, or why there is none. */
template <class T> struct Answer {
    T value{};
    Outcome outcome = Outcome::Answered;
    std::string why; /**< in words, unless it is answered */
    explicit operator bool() const { return outcome == Outcome::Answered; }
};

/** What a place is, as Markdown. `name` is empty where it is no name that is known, and `facts` where
 *  nothing is proved there. */
struct Hover {
    Stretch at;                        /**< the word; may be empty */
    std::vector<std::string> errors;   /**< messages with their witnesses */
    std::string name;                  /**< type, head and doc of the name */
    std::vector<LibraryEntry> entries; /**< of the library, that the name means */
    std::vector<std::string> facts;    /**< what is proved of the shapes here */
    bool empty() const { return errors.empty() && name.empty() && facts.empty(); }
};

/** What is proved of a top-level statement's shapes: of the steepest of them. */
struct BoundAt {
    Stretch at;
    double lipschitz = 0;
    std::string words; /**< "bound 1.2, proved, exact" */
};

/** The name of an argument that is given by its place, and where that begins. */
struct ArgumentName {
    std::size_t at = 0;
    std::string name;
};

/** Something that may stand at a place. */
struct CompletionItem {
    enum class Kind {
        Method,
        Function,
        Field,
        Variable,
        Module,
        Unit,
        Keyword,
        Color,
        File,
        Folder,
        Constant,
        Type
    };
    std::string label;
    Kind kind = Kind::Variable;
    std::string detail;        /**< a signature, a type; may be empty */
    std::string documentation; /**< Markdown; may be empty */
    std::string insert;        /**< in place of the label; empty: the label */
    bool snippet = false;      /**< `insert` has places to fill: `${1:name}` and `$0` */
    std::string sort;          /**< what it is sorted by; empty: the label */
};

/** The forms of the function whose call a place lies in. */
struct SignatureHelp {
    struct Form {
        std::string signature, documentation;
        std::vector<std::string> parameters; /**< "radius: float = 1" */
        std::size_t active = 0;              /**< the parameter that the place is about */
    };
    std::vector<Form> forms; /**< empty: no call, or of a function that is not known */
    std::size_t active = 0;  /**< the form that fits */
};

enum class SymbolKind { Module, Function, Variable, Constant };

/** A declaration of a text, with those inside of it. */
struct DocumentSymbol {
    std::string name;
    SymbolKind kind = SymbolKind::Variable;
    Stretch whole, at; /**< the statement, and the name in it */
    std::vector<DocumentSymbol> inside;
};

/** A top-level declaration of the workspace. */
struct WorkspaceSymbol {
    std::string name;
    SymbolKind kind = SymbolKind::Variable;
    Location at;
};

/** A place of the text that says a name. */
struct Highlight {
    Stretch at;
    bool written = false; /**< declared or assigned here; else read */
};

/** A file that a text names, and that is there. */
struct DocumentLink {
    Stretch at;
    std::string path;
};

/** A file or a folder that gets another name. */
struct RenamedFile {
    std::string from, to;
};

/** A word or a comment, and what it means. */
struct SemanticToken {
    enum class Meaning {
        Comment,
        Keyword,
        String,
        Number,
        Operator,
        Function,
        Method,
        Variable,
        Parameter,
        Property,
        Type,
        Module
    };
    Stretch at; /**< of a comment, over several lines */
    Meaning meaning = Meaning::Variable;
    bool declared = false; /**< the name is declared here */
    bool constant = false; /**< what it names cannot be assigned */
    bool library = false;  /**< it is the library's */
};

/** Lines that an editor may fold, counted from 1; the first stays seen. */
struct FoldingRange {
    enum class Kind { Brackets, Imports, Comment };
    int first = 0, last = 0;
    Kind kind = Kind::Brackets;
};

/** A colour that a text says, by numbers or by name. */
struct ColorAt {
    Stretch at;
    std::array<double, 4> rgba{}; /**< sRGB, 0 to 1 */
};

/** Edits that one may want, and what they are called. */
struct CodeAction {
    enum class Kind { Fix, Extract, Inline, Rewrite };
    std::string title;
    Kind kind = Kind::Fix;
    std::optional<Diagnostic> fixes; /**< what a fix is for */
    std::vector<TextEdit> edits;
};
/** Which of them are looked for. */
struct ActionKinds {
    bool fixes = true, extractions = true, inlinings = true, rewritings = true;
};

/** Open texts, the files beside them, and what editors ask of them. Texts are named by their paths,
 *  places in them by bytes. A text is read and compiled when that is first wanted, and again after it
 *  changed; it is answered as well as it can be where it has errors. What texts import is read from
 *  the open ones, else from files; nothing is written. For one
 *  thread at a time. No call throws; one that was made without memory, or moved from, answers
 *  nothing. */
class FATHOM_API Workspace {
  public:
    Workspace();
    Workspace(Workspace &&) noexcept;
    Workspace &operator=(Workspace &&) noexcept;
    ~Workspace();

    /** Folders whose scenes belong to it; none: those of the open texts. */
    void set_folders(std::vector<std::string> folders);
    /** Asked while a text is compiled. Where it says yes, the question ends as `Outdated`. */
    void set_outdated(std::function<bool()> outdated);

    /** Opens a text, or gives an open one other content; closes one; tells that files have changed.
     *  The open texts that may be answered differently now. */
    std::vector<std::string> set_text(const std::string &path, std::string text);
    std::vector<std::string> close(const std::string &path);
    std::vector<std::string> files_changed();
    /** The open text at a path, else that of the file, of at most 1 MiB. It lives until the next call
     *  that is not `text`. */
    std::optional<std::string_view> text(const std::string &path);

    Answer<std::vector<Diagnostic>> diagnostics(const std::string &path);
    Answer<Hover> hover(const std::string &path, std::size_t at);
    Answer<std::vector<BoundAt>> bounds(const std::string &path);
    /** Why the bounds are what they are. Refused where the text has errors. */
    Answer<Explanation> explanation(const std::string &path);
    Answer<std::vector<ArgumentName>> argument_names(const std::string &path, Stretch within);

    Answer<std::vector<CompletionItem>> completion(const std::string &path, std::size_t at,
                                                   bool snippets = false);
    Answer<SignatureHelp> signature_help(const std::string &path, std::size_t at);

    /** Where the name at a place is declared, or the file that is named there. */
    Answer<std::optional<Location>> definition(const std::string &path, std::size_t at);
    Answer<std::vector<Location>> references(const std::string &path, std::size_t at,
                                             bool with_declaration = true);
    Answer<std::vector<Highlight>> highlights(const std::string &path, std::size_t at);
    Answer<std::vector<DocumentSymbol>> symbols(const std::string &path);
    /** Names of the workspace that have the letters of `query` in this order. */
    Answer<std::vector<WorkspaceSymbol>> find_symbols(const std::string &query);
    Answer<std::vector<DocumentLink>> links(const std::string &path);

    /** The name at a place, where it can be renamed. */
    Answer<std::optional<Stretch>> renamable(const std::string &path, std::size_t at);
    /** In all files of the workspace. Refused where a name would mean something else then, or what
     *  compiles would not. */
    Answer<WorkspaceEdit> rename(const std::string &path, std::size_t at, const std::string &name);
    /** Before files get other names: what names them is written anew. */
    Answer<WorkspaceEdit> rename_files(const std::vector<RenamedFile> &files);

    Answer<std::vector<SemanticToken>> tokens(const std::string &path, Stretch within);
    Answer<std::vector<FoldingRange>> folding(const std::string &path);
    /** What a selection at a place grows to, the whole text first. */
    Answer<std::vector<Stretch>> selections(const std::string &path, std::size_t at);
    Answer<std::vector<ColorAt>> colors(const std::string &path);

    /** The form of `format_text`, as edits within a stretch. */
    Answer<std::vector<TextEdit>> format(const std::string &path, Stretch within);
    /** After a character was typed, which ends at `at`: of `}` its block, of a new line the statement
     *  above. */
    Answer<std::vector<TextEdit>> format_typed(const std::string &path, std::size_t at, char typed);
    /** Fixes of what is wrong in a stretch, and changes of what is selected that keep its meaning.
     *  Each but a fix was compiled. */
    Answer<std::vector<CodeAction>> actions(const std::string &path, Stretch within,
                                            const ActionKinds &kinds = {});

    struct Impl;

  private:
    std::unique_ptr<Impl> impl_;
};

/** How a colour is written, sRGB from 0 to 1: "#ff6347", and its name where it has one. */
FATHOM_API std::vector<std::string> color_texts(const std::array<double, 4> &rgba);

/** Params whose number alone differs between two texts that are the same otherwise, with their new
 *  values (angles in radians); empty where anything else differs, or nothing does. */
FATHOM_API std::vector<std::pair<std::string, double>> moved_params(std::string_view before,
                                                                    std::string_view after);

} // namespace fathom::FATHOM_V1

#include "tests/unit/save/support.h"

#include "save-format/import/importer.h"

#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <sstream>

namespace save_test {
namespace {

const std::vector<typecheck::LibraryFile> &library() {
    static std::vector<std::pair<std::string, std::string>> texts;
    static const std::vector<typecheck::LibraryFile> files = [] {
        for (const auto &entry : std::filesystem::directory_iterator(FATHOM_SOURCE_DIR "/stdlib")) {
            if (entry.path().extension() != ".sdf") continue;
            std::ifstream in(entry.path());
            std::stringstream text;
            text << in.rdbuf();
            const std::string name = entry.path().filename().string();
            texts.emplace_back(name == "dfmodel.sdf" ? "dfmodel" : name, text.str());
        }
        std::vector<typecheck::LibraryFile> made;
        for (const auto &[name, text] : texts) made.push_back({name, text, name != "dfmodel"});
        return made;
    }();
    return files;
}

std::string lines(const Diagnostics &diagnostics, const Sources &sources, bool errors_only) {
    std::string text;
    for (const Diagnostic &d : diagnostics.sorted()) {
        if (errors_only && d.severity != Severity::Error) continue;
        if (d.primary.span.source) {
            const Position at = position(sources[d.primary.span.source], d.primary.span.begin);
            text += fmt::format("{}:{} ", at.line, at.column);
        }
        text += std::string(d.severity == Severity::Error ? "error " : "") +
                std::string(code_name(d.code)) + " " + d.message + "\n";
    }
    return text;
}

} // namespace

std::string Imported::said() const { return lines(diagnostics, *sources, false); }
std::string CheckedText::errors() const { return lines(diagnostics, *sources, true); }

Imported import_text(std::string yaml, save::ImportOptions options) {
    Imported imported;
    const SourceId id = imported.sources->add("a.yaml", std::move(yaml));
    imported.result = save::import_yaml(*imported.sources, id, imported.diagnostics, options);
    return imported;
}

CheckedText check_text(std::string sdf) {
    CheckedText made;
    const SourceId id = made.sources->add("a.sdf", std::move(sdf));
    typecheck::Loader loader;
    loader.text = [](const std::string &, const std::string &) {
        return typecheck::LoadError{typecheck::LoadError::Reason::NotFound, "no such file"};
    };
    loader.identity = [](const std::string &name, const std::string &) { return name; };
    loader.image = [](const std::string &name, const std::string &, typecheck::Room &) {
        return ir::ImageData{name, 1, 1, {1, 1, 1, 1}};
    };
    loader.grid = [](const std::string &name, const std::string &, typecheck::Room &,
                     const std::string &) {
        return ir::GridData{name, {2, 2, 2}, {1, 1, 1, 1, 1, 1, 1, 1}};
    };
    made.checked =
        typecheck::check(*made.sources, id, "a.sdf", library(), loader, {}, made.diagnostics);
    return made;
}

std::string export_text(const ir::Scene &scene) {
    Diagnostics diagnostics;
    return save::export_yaml(scene, diagnostics);
}

std::string difference(const save::Value &a, const save::Value &b, const std::string &place) {
    using save::Value;
    if (a.kind != b.kind) return place + ": another kind of value";
    if (a.kind == Value::Kind::Scalar) {
        const auto x = save::number_of(a), y = save::number_of(b);
        if (x && y) return *x == *y ? "" : place + ": " + a.text + " became " + b.text;
        return a.text == b.text ? "" : place + ": " + a.text + " became " + b.text;
    }
    if (a.items.size() != b.items.size())
        return fmt::format("{}: {} items became {}", place, a.items.size(), b.items.size());
    for (std::size_t i = 0; i < a.items.size(); ++i) {
        std::string found = difference(a.items[i], b.items[i], fmt::format("{}/{}", place, i));
        if (!found.empty()) return found;
    }
    // Every entry of the first; the second may say defaults that the first leaves out.
    for (const auto &[key, value] : a.entries) {
        const Value *other = b.find(key);
        if (!other) return place + "/" + key + ": is lost";
        std::string found = difference(value, *other, place + "/" + key);
        if (!found.empty()) return found;
    }
    return "";
}

std::string file_of(const std::string &nodes, const std::string &materials) {
    return "- 0.3\n- {}\n- " + materials + "\n- [Generic, Distance field, {Children: [\n" + nodes +
           "]}]\n- [LightingNode, Lighting, {}]\n- 100\n";
}

} // namespace save_test

// What a call's arguments are called, of functions of the text, of imported ones and of the library.
#pragma once

#include "api/language/targets.h"

namespace fathom::language {

// A function that a name may mean, in words.
struct Form {
    std::string signature, doc;
    Signature read;
};
Form form_of(const File &home, const Declaration &function);
// All forms; none where it is no function that is known.
std::vector<Form> forms_of(Workspace &workspace, const File &file, const Use &use);
// Of a name that was never finished: the text's own declaration of it, else the library's.
std::vector<Form> forms_named(Workspace &workspace, const File &file, const std::string &name);

// What the parameter is called that a call's argument goes to by its place; empty where that is not
// sure. The object before a dot is the argument 0.
std::string parameter_at(const std::vector<Form> &forms, std::size_t index, std::size_t count);

} // namespace fathom::language

// Programs made at random: correct ones, in every construct of the language and an ugly layout, and
// broken ones.
#pragma once

#include <string>

namespace lang_test {

std::string random_program(unsigned seed);

// A text with bytes and words deleted, doubled, swapped and put in.
std::string mutated(const std::string &text, unsigned seed);

} // namespace lang_test

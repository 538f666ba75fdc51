// Which number literals of a shader's text are being edited, so that they can be sent as data and
// the driver has nothing to compile. Works on text alone: two texts that differ in float literals
// only are one program with other numbers. Knows neither the scene nor GL.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace fathom::viewer {

// A text with its edited literals as uniforms, and their values.
struct Slots {
    std::string text; // as emitted
    std::vector<std::size_t>
        edited; // which of its float literals, counted from 0, are data; ascending
};

// Of a fresh text that differs in edited literals only: their values. Nothing where something else
// differs too.
std::optional<std::vector<float>> values_in(const Slots &slots, const std::string &fresh);

// The fresh text with every literal that ever differed as data; nothing where more than literals
// differ, or too many.
std::optional<Slots> widened(const Slots &slots, const std::string &fresh);

// The text for the driver: `fathom_edited[k]` for the k-th slot.
std::string text_with_slots(const Slots &slots);

} // namespace fathom::viewer

// What readers of words share: looking at the next ones, and taking them.
#pragma once

#include "lang/foreign/program/program.h"

#include <algorithm>

namespace fathom::lang::program {

class PieceReader {
  public:
    explicit PieceReader(const std::vector<Piece> &pieces) : pieces_(pieces) {}

  protected:
    // The word at hand. Who looks at words for ever is not sure of them.
    const Piece &now() const {
        constexpr std::size_t looks_a_piece = 2000, least = 100'000;
        if (++looks_ > least + looks_a_piece * pieces_.size() || at_ >= pieces_.size())
            throw Unsure{};
        return pieces_[at_];
    }
    const Piece &next(std::size_t n = 1) const {
        return pieces_[std::min(at_ + n, pieces_.size() - 1)];
    }
    bool sees(std::string_view text) const {
        return now().kind != Word::Text && now().kind != Word::End && now().text == text;
    }
    bool takes(std::string_view text) {
        if (!sees(text)) return false;
        ++at_;
        return true;
    }
    void want(std::string_view text) {
        if (!takes(text)) throw Unsure{};
    }
    std::string name() {
        if (now().kind != Word::Name) throw Unsure{};
        return pieces_[at_++].text;
    }
    // A row of parts, each around those before it.
    static void longer(int &row) {
        constexpr int longest = 100;
        if (++row > longest) throw Unsure{};
    }
    // How deep the reader is in itself.
    struct Depth {
        explicit Depth(PieceReader &r) : of(r) {
            constexpr int deepest = 60;
            if (++of.depth_ > deepest) throw Unsure{};
        }
        ~Depth() { --of.depth_; }
        PieceReader &of;
    };

    const std::vector<Piece> &pieces_;
    std::size_t at_ = 0;

  private:
    int depth_ = 0;
    mutable std::size_t looks_ = 0;
};

} // namespace fathom::lang::program

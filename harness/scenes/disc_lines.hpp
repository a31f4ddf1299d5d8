#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string_view>

#include "kernels/scene.hpp"

namespace carom {

/// A text that several threads may read at once, piece by piece.
struct Pieces {
    std::size_t size; ///< in bytes

    /// The bytes from `offset` on, at most as many as `buffer` holds, in it or elsewhere. Throws nothing.
    std::function<std::string_view(std::size_t offset, std::span<char> buffer)> at;
};

/// Reads lines `i x y vx vy`, from `begin` to the end of the text, into `discs`, on at most so many threads.
/// False if there is anything else than one good line for each disc, or a line that is very long: `discs`
/// then mean nothing, and it takes another reader to tell which line comes first that is wrong.
bool read_disc_lines(const Pieces& text, std::size_t begin, std::span<Disc> discs, int threads);

} // namespace carom

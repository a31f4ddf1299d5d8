#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/support/text.hpp"
#include "kernels/scene.hpp"

namespace carom {

/// Largest magnitude of any length or speed, and the reciprocal of the smallest radius: squares of squares
/// stay finite.
inline constexpr double largest_number = 1e60;
inline constexpr double smallest_radius = 1e-60;

/// Most discs a scene may have.
inline constexpr int most_discs = 100'000'000;

/// Parses the published text format: N, L, r and S, one a line, then N lines `i x y vx vy`, in any order of
/// i. `name` stands for the file in errors. Throws InputError with file, line, what was found and what was
/// expected; nothing is allocated for discs that the text is too short to hold.
Scene parse_scene(std::string_view text, const std::string& name);

/// Is told of a scene, still without its discs, and how many these are, before there is memory for them.
/// Throws InputError if there is too little for what is to be done with them.
using RequireRoom = std::function<void(const Scene& box, std::size_t discs)>;

/// Requires room for the discs themselves.
void require_room_for_discs(const Scene& box, std::size_t discs);

/// Reads and parses a scene file, or standard input for "-". Throws InputError.
Scene read_scene(const std::filesystem::path& path, const RequireRoom& require_room = require_room_for_discs);

/// The text that `parse_scene` reads back as the same scene, to the last bit.
std::string scene_text(const Scene& scene);

/// Appends one disc as it stands in a scene's file: a line `i x y vx vy`.
template <class Real> void append_disc(std::string& text, std::size_t i, const BasicDisc<Real>& disc) {
    append_number(text, i);
    for (const Real value : {disc.x, disc.y, disc.vx, disc.vy}) {
        text += ' ';
        append_number(text, value);
    }
    text += '\n';
}

/// All of them, a line each.
template <class Real> std::string disc_lines(const std::vector<BasicDisc<Real>>& discs) {
    std::string text;
    for (std::size_t i = 0; i < discs.size(); ++i) {
        append_disc(text, i, discs[i]);
    }
    return text;
}

/// Throw InputError, with `where` in front, if `parse_scene` would not accept the number.
void require_radius(double radius, const std::string& where);
void require_side(double side, double radius, const std::string& where);

} // namespace carom

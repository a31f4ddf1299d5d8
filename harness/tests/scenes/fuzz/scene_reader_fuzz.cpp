#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "harness/scenes/scene_file.hpp"
#include "harness/support/errors.hpp"

namespace carom {
namespace {

/// Ends the process, which makes libFuzzer keep the input.
void require(bool holds, const char* what) {
    if (!holds) {
        std::fprintf(stderr, "the scene reader broke its promise: %s\n", what);
        std::abort();
    }
}

bool in_bounds(double number) { return std::abs(number) <= largest_number; }

void require_promised(const Scene& scene) {
    require(scene.radius >= smallest_radius && in_bounds(scene.radius), "the radius is in its bounds");
    require(scene.side >= 2 * scene.radius && in_bounds(scene.side), "the side is in its bounds");
    require(scene.steps >= 0, "the number of steps is in its bounds");
    for (const Disc& disc : scene.discs) {
        require(in_bounds(disc.x) && in_bounds(disc.y), "positions are in their bounds");
        require(in_bounds(disc.vx) && in_bounds(disc.vy), "velocities are in their bounds");
    }
    const Scene again = parse_scene(scene_text(scene), "again");
    require(again.side == scene.side && again.radius == scene.radius && again.steps == scene.steps &&
                again.discs == scene.discs,
            "a scene written is read back as it was");
}

/// NAME:LINE: found ..., expected ..., in one line of printable letters.
void require_one_line(std::string_view message) {
    require(message.starts_with("scene:"), "an error begins with the file's name and the line");
    require(message.find(": found ") != message.npos && message.find(", expected ") != message.npos,
            "an error says what was found and what was expected");
    for (const char letter : message) {
        require(letter >= ' ' && letter <= '~', "an error is one line of printable letters");
    }
}

/// The scene as text, or the error.
std::string outcome(std::string_view text) {
    try {
        return scene_text(parse_scene(text, "scene"));
    } catch (const InputError& error) {
        return error.what();
    }
}

/// A first disc so far from its line's beginning that discs are read line by line: the outcome is the same.
void require_same_line_by_line(std::string_view text) {
    std::size_t header = 0;
    for (int line = 0; line < 4 && header != text.npos; ++line) {
        header = text.find('\n', header);
        header += header == text.npos ? 0 : 1;
    }
    if (header >= text.size() || outcome(text).find("too short") != std::string::npos) {
        return;
    }
    std::string indented(text);
    indented.insert(header, 5000, ' ');
    require(outcome(indented) == outcome(text), "how lines are read makes no difference");
}

} // namespace
} // namespace carom

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    try {
        carom::require_promised(carom::parse_scene(text, "scene"));
    } catch (const carom::InputError& error) {
        carom::require_one_line(error.what());
    }
    carom::require_same_line_by_line(text);
    return 0;
}

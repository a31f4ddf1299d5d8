#pragma once

#include <span>
#include <string_view>

#include "kernels/scene.hpp"

namespace carom {

/// A scene that is hard to simulate right, by name. What is expected of it is asserted in
/// tests/hard_cases_test.cpp and derived there.
struct HardCase {
    std::string_view name;
    std::string_view description; ///< one line: what it is and why it is hard
    Scene (*scene)();
};

/// Every hard case.
std::span<const HardCase> hard_cases();

/// The hard case of that name, or null.
const HardCase* find_hard_case(std::string_view name);

/// The scene that scaled_down, scaled_up, renumbered, mirrored, rotated and reversed change: discs far apart,
/// all different, no three of which meet.
Scene plain_scene();

} // namespace carom

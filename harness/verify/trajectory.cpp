#include "harness/verify/trajectory.hpp"

#include "harness/support/errors.hpp"
#include "harness/support/format.hpp"
#include "harness/verify/disc_states.hpp"

namespace carom {
namespace {

/// Of doubles, written in decimal.
constexpr int exact_digits = 17;
constexpr int surely_rounded_digits = 15;

void require_start(const Scene& scene, const std::vector<Disc>& discs, const std::string& path) {
    for (std::size_t i = 0; i < discs.size(); ++i) {
        if (discs[i] != scene.discs[i]) {
            throw InputError(path + format(": begins with disc %zu at %s, expected the scene's %s", i,
                                           state_text(discs[i]).c_str(), state_text(scene.discs[i]).c_str()));
        }
    }
}

std::vector<Disc> rounded(std::vector<Disc> discs, const Rounding& rounding) {
    for (Disc& disc : discs) {
        disc = {rounding(disc.x), rounding(disc.y), rounding(disc.vx), rounding(disc.vy)};
    }
    return discs;
}

} // namespace

CheckedTrajectory check_trajectory(const Scene& scene, TrajectoryFile& file, const Checker& checker,
                                   const Rounding& rounding) {
    const std::vector<Disc> start = file.next();
    require_start(scene, start, file.path());
    CheckedTrajectory checked{.discs = rounded(start, rounding), .violation = std::nullopt};
    for (int step = 1; step <= scene.steps; ++step) {
        std::vector<Disc> after = file.next();
        if (const auto violation = checker.step(checked.discs, after)) {
            checked.violation = format("step %d: ", step) + *violation;
            if (file.most_digits() <= surely_rounded_digits) {
                *checked.violation += format(" (no number of the file has more than %d digits; it takes %d)",
                                             file.most_digits(), exact_digits);
            }
            return checked;
        }
        checked.discs = std::move(after);
    }
    file.require_end();
    return checked;
}

} // namespace carom

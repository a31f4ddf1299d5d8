#pragma once

#include <cstddef>
#include <vector>

#include "kernels/collide.hpp"
#include "kernels/policies.hpp"
#include "kernels/scene.hpp"
#include "kernels/state.hpp"

namespace carom {

/// The slow, obvious reference: one time step in which every disc looks at every other one, O(N^2) a sweep,
/// with no boxes, no lists and no threads. Discs are visited by number and partners by number, backwards
/// under Direction::reverse; a disc is visited once a sweep (`order` once) or again and again while it
/// changes (any other). Equal, to the last bit, to a sequential variant wherever that one finds overlaps in
/// the order of the numbers, as in a scene of one box.
class AllPairs {
  public:
    AllPairs(const Scene& scene, const Policies& policies, const Tuning& tuning)
        : scene_(scene), policies_(policies), tuning_(tuning), approaching_(tuning.tolerance) {}

    const std::vector<Disc>& discs() const { return scene_.discs; }

    Tally step() {
        const double dt = 1.0 / tuning_.substeps;
        for (Disc& disc : scene_.discs) {
            disc.x += disc.vx * dt;
            disc.y += disc.vy * dt;
        }
        Tally total;
        if (policies_.self_contained == SelfContained::on) {
            for (std::size_t i = 0; i < scene_.discs.size(); ++i) {
                total += against_all(i, Direction::forward);
            }
        }
        for (bool changed = true; changed; ++total.sweeps) {
            if (total.sweeps == tuning_.sweep_limit) {
                total.settled = false;
                return total;
            }
            const Tally tally = sweep();
            total += tally;
            changed = tally.changed();
        }
        return total;
    }

  private:
    Tally sweep() {
        Tally total;
        for (std::size_t i = 0; i < scene_.discs.size(); ++i) {
            bool again = true;
            for (int pass = 0; again && pass < passes_per_visit; ++pass) {
                Tally tally;
                tally.wall_resolves = resolve_walls(scene_.discs[i], scene_.side, scene_.radius);
                tally += against_all(i, policies_.direction);
                total += tally;
                again = policies_.order != Order::once && tally.changed();
            }
        }
        return total;
    }

    Tally against_all(std::size_t i, Direction direction) {
        Tally tally;
        const std::size_t count = scene_.discs.size();
        const double reach = 2 * scene_.radius;
        for (std::size_t k = 0; k < count; ++k) {
            const std::size_t j = direction == Direction::forward ? k : count - 1 - k;
            if (i != j && overlap(scene_.discs[i], scene_.discs[j], reach * reach)) {
                tally.pair_resolves += resolve_pair(scene_.discs[i], scene_.discs[j], approaching_);
            }
        }
        return tally;
    }

    Scene scene_;
    Policies policies_;
    Tuning tuning_;
    Approach<double> approaching_;
};

} // namespace carom

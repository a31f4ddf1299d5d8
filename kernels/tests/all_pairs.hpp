#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "kernels/collide.hpp"
#include "kernels/policies.hpp"
#include "kernels/scene.hpp"
#include "kernels/state.hpp"

namespace carom {

/// The slow, obvious reference: one time step in which every disc looks at every other one, O(N^2) a sweep,
/// with no boxes, no lists and no threads. Discs are visited by number and partners by number, backwards
/// under Direction::reverse; a disc is visited once a sweep (`order` once) or again and again while it
/// changes (any other). With self-contained resolves all discs count as those of one box. Equal, to the last
/// bit, to a sequential variant in a scene of one box.
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
            total += within_box();
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
    /// Each pair once; then each disc until it is at rest; then again those that one after them changed,
    /// until none is left.
    Tally within_box() {
        Tally total;
        for (std::size_t i = 0; i < scene_.discs.size(); ++i) {
            for (std::size_t j = i + 1; j < scene_.discs.size(); ++j) {
                total += against(i, j);
            }
        }
        std::vector<std::size_t> remembered;
        for (std::size_t i = 0; i < scene_.discs.size(); ++i) {
            total += visit(i, policies_.direction, true, [&](std::size_t j) {
                if (j < i) {
                    remembered.push_back(j);
                }
            });
        }
        for (int round = 0; round < rounds_within_box && !remembered.empty(); ++round) {
            for (const std::size_t i : std::exchange(remembered, {})) {
                total += visit(i, Direction::forward, true, [&](std::size_t j) { remembered.push_back(j); });
            }
        }
        return total;
    }

    Tally sweep() {
        Tally total;
        for (std::size_t i = 0; i < scene_.discs.size(); ++i) {
            total += visit(i, policies_.direction, false, [](std::size_t) {});
        }
        return total;
    }

    /// Passes over a disc's partners, and its walls unless it is visited within a box.
    template <class OnPartner>
    Tally visit(std::size_t i, Direction direction, bool within_box, const OnPartner& on_partner) {
        Tally total;
        const bool again = within_box || policies_.order != Order::once;
        for (int pass = 0; pass < (again ? passes_per_visit : 1); ++pass) {
            Tally tally = against_all(i, direction, on_partner);
            if (!within_box) {
                tally.wall_resolves = resolve_walls(scene_.discs[i], scene_.side, scene_.radius);
            }
            total += tally;
            if (!tally.changed()) {
                break;
            }
        }
        return total;
    }

    template <class OnPartner>
    Tally against_all(std::size_t i, Direction direction, const OnPartner& on_partner) {
        Tally total;
        const std::size_t count = scene_.discs.size();
        for (std::size_t k = 0; k < count; ++k) {
            const std::size_t j = direction == Direction::forward ? k : count - 1 - k;
            const Tally tally = i == j ? Tally{} : against(i, j);
            total += tally;
            if (tally.changed()) {
                on_partner(j);
            }
        }
        return total;
    }

    Tally against(std::size_t i, std::size_t j) {
        const double reach = 2 * scene_.radius;
        Tally tally;
        if (overlap(scene_.discs[i], scene_.discs[j], reach * reach)) {
            tally.pair_attempts = 1;
            tally.pair_resolves = resolve_pair(scene_.discs[i], scene_.discs[j], approaching_);
        }
        return tally;
    }

    Scene scene_;
    Policies policies_;
    Tuning tuning_;
    ApproachTolerance<double> approaching_;
};

} // namespace carom

#include "harness/accuracy/momentum_watch.hpp"

#include <cstddef>
#include <utility>

#include "harness/verify/at_contact.hpp"

namespace carom {

MomentumWatch::MomentumWatch(const Scene& scene, const Rounding& rounding, Impact impact, double dt,
                             std::vector<Disc> start)
    : walls_{.side = rounding(scene.side), .radius = rounding(scene.radius), .rounding = rounding},
      impact_(impact), dt_(rounding(dt)), balance_(impact == Impact::at_contact ? widened(walls_) : walls_),
      before_(std::move(start)) {}

void MomentumWatch::step(const std::vector<Disc>& discs, const std::vector<OverlappingPair>& pairs) {
    if (impact_ == Impact::at_contact) {
        balance_at_contact(discs);
    } else {
        balance_.add(before_, discs, pairs);
    }
    before_ = discs;
}

void MomentumWatch::step(const std::vector<Disc>& discs) {
    const bool needed = impact_ != Impact::at_contact;
    step(discs,
         needed ? overlapping_pairs(discs, walls_.radius, walls_.rounding) : std::vector<OverlappingPair>());
}

/// The walls were met where the discs flew freely, not where they are.
void MomentumWatch::balance_at_contact(const std::vector<Disc>& discs) {
    std::vector<Disc> free = flown(before_, dt_, walls_);
    const auto pairs = colliding_pairs(free, discs, walls_);
    for (std::size_t i = 0; i < free.size(); ++i) {
        free[i].vx = discs[i].vx;
        free[i].vy = discs[i].vy;
    }
    balance_.add(before_, free, pairs);
}

} // namespace carom

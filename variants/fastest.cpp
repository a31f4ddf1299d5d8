#include "variants/fastest.hpp"

#include <cstddef>

namespace carom {
namespace {

/// Of so many discs, no matter on how many threads, so that a result never depends on their number.
///
/// Fitted to the records of the question small_scenes on 2 cores. With 2 threads the time of `once` over that
/// of the last rung of the ladder is 0.39, 0.57, 0.87, 1.4, 2.3 and 3.2 for 10, 30, 100, 300, 1000 and 3000
/// discs; measured alike with one thread, 0.38, 0.76, 1.6, 2.1 and 2.9 for 10 to 1000. They cross at about
/// 110 discs and at about 50. In larger scenes no rung is ahead of the last by more than 7.4 % on any scene
/// of the study, at area fractions from nearly 0 to 0.91 (see docs/performance.md).
constexpr std::size_t most_discs_for_once = 70;

} // namespace

const Variant& fastest_variant(const Scene& scene) {
    return scene.discs.size() <= most_discs_for_once ? *find_variant("once") : fastest_variant();
}

const Variant& fastest_variant() {
    return *find_variant(
        "nine-wavefront-self_contained_off-resolve_dynamic-sorted-snug-contacts-filtered-active");
}

} // namespace carom

#include "variants/fastest.hpp"

#include <cstddef>
#include <limits>
#include <string_view>

namespace carom {
namespace {

/// For scenes of at most so many discs.
struct Rule {
    std::size_t most_discs;
    std::string_view variant;
};

/// The first rule that fits decides.
///
/// Fitted to the records of the question small_scenes on 2 cores, before the order wavefront became the last
/// rung: with 2 threads the time of `once` over that of the last rung of the ladder is 0.24, 0.42,
/// 0.74, 1.24, 2.4 and 4.0 for 10, 30, 100, 300, 1000 and 3000 discs. They cross at about 200; with one
/// thread, measured alike, at about 150. In larger scenes no rung is ahead of the last by more than 6 % on
/// any scene of the study, at area fractions from nearly 0 to 0.91 (see docs/performance.md).
constexpr Rule rules[] = {
    {.most_discs = 150, .variant = "once"},
    {.most_discs = std::numeric_limits<std::size_t>::max(),
     .variant = "nine-wavefront-self_contained_off-resolve_dynamic-sorted-snug-contacts-filtered-active"},
};

} // namespace

const Variant& fastest_variant(const Scene& scene) {
    const Rule* rule = rules;
    while (scene.discs.size() > rule->most_discs) {
        ++rule;
    }
    return *find_variant(rule->variant);
}

} // namespace carom

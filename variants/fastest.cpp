#include "variants/fastest.hpp"

#include <cstddef>
#include <limits>
#include <string_view>

namespace carom {
namespace {

/// For scenes of at most so many discs on at least so many threads.
struct Rule {
    std::size_t most_discs;
    int least_threads;
    std::string_view variant;
};

constexpr auto any = std::numeric_limits<std::size_t>::max();

/// The first rule that fits decides.
constexpr Rule rules[] = {
    {.most_discs = any,
     .least_threads = 1,
     .variant = "nine-strips-self_contained_off-resolve_dynamic-sorted-snug-contacts-filtered-active"},
};

} // namespace

const Variant& fastest_variant(const Scene& scene, int threads) {
    for (const Rule& rule : rules) {
        if (scene.discs.size() <= rule.most_discs && threads >= rule.least_threads) {
            return *find_variant(rule.variant);
        }
    }
    return variants().front();
}

} // namespace carom

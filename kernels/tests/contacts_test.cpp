#include <algorithm>
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "kernels/step.hpp"
#include "kernels/tests/fast_policies.hpp"
#include "kernels/tests/scenes.hpp"
#include "kernels/tests/simulate.hpp"

namespace carom {
namespace {

using tests::active;
using tests::filtered;
using tests::same_bits;
using tests::snug;

State<active> found(const Scene& scene) {
    State<active> state(scene);
    NoProbe probe;
    move(state, {}, probe);
    bin(state, {}, probe);
    find(state, {}, probe);
    return state;
}

/// A contact with the strip and, counted over all rows from the first, the segment that it stands in.
struct Place {
    int strip;
    std::ptrdiff_t segment;
    OverlappingDiscs discs;
};

std::vector<Place> places(State<active>& state) {
    std::vector<Place> found;
    for (int s = 0; s < static_cast<int>(state.strips.size()); ++s) {
        const auto& strip = state.strips[static_cast<std::size_t>(s)];
        const std::ptrdiff_t first_segment =
            static_cast<std::ptrdiff_t>(s) * strip_height(Order::strips) * state.active.per_row();
        for (std::size_t b = 0; b + 1 < strip.contact_begin.size(); ++b) {
            for (int c = strip.contact_begin[b]; c < strip.contact_begin[b + 1]; ++c) {
                found.push_back({s, first_segment + static_cast<std::ptrdiff_t>(b),
                                 strip.contacts[static_cast<std::size_t>(c)].discs});
            }
        }
    }
    return found;
}

std::set<std::ptrdiff_t> marked_by(State<active>& state, int disc) {
    const int per_row = state.active.per_row();
    for (int row = 0; row < state.grid.boxes_per_side(); ++row) {
        std::fill_n(state.active.row(row), per_row, static_cast<unsigned char>(0));
    }
    state.active.marker().mark(state.segments_of_disc[static_cast<std::size_t>(disc)]);
    std::set<std::ptrdiff_t> segments;
    for (int row = 0; row < state.grid.boxes_per_side(); ++row) {
        for (int segment = 0; segment < per_row; ++segment) {
            if (state.active.row(row)[segment] != 0) {
                segments.insert(static_cast<std::ptrdiff_t>(row) * per_row + segment);
            }
        }
    }
    return segments;
}

/// Scenes wide enough for many segments in a row, and the odd ones.
std::vector<tests::NamedScene> scenes_with_segments() {
    std::vector<tests::NamedScene> scenes = tests::all_scenes();
    scenes.push_back({"many segments", tests::random_scene_of_density(4000, 0.9, 2, 71)});
    return scenes;
}

TEST(ActiveSegments, AreAllThatHoldAContactOfTheDiscAndFewMore) {
    for (const auto& [name, scene] : scenes_with_segments()) {
        SCOPED_TRACE(name);
        auto state = found(scene);
        std::map<int, std::set<std::ptrdiff_t>> segments_of;
        for (const Place& place : places(state)) {
            segments_of[place.discs.first].insert(place.segment);
            segments_of[place.discs.second].insert(place.segment);
        }
        for (int disc = 0; disc < state.count(); ++disc) {
            const auto marked = marked_by(state, disc);
            EXPECT_LE(marked.size(), 4);
            EXPECT_TRUE(std::ranges::includes(marked, segments_of[disc])) << "disc " << disc;
        }
    }
}

/// The proof of resolve_contacts.hpp, looked at: strips of one parity share no disc, and mark no segment
/// alike.
TEST(StripsOfContacts, ShareNoDiscAndNoMarkWithinAParity) {
    for (const auto& [name, scene] : scenes_with_segments()) {
        SCOPED_TRACE(name);
        auto state = found(scene);
        std::map<std::pair<int, int>, std::set<int>> strips_of_disc; // and of a parity
        for (const Place& place : places(state)) {
            for (const int disc : {place.discs.first, place.discs.second}) {
                strips_of_disc[{disc, place.strip % 2}].insert(place.strip);
            }
        }
        std::map<std::pair<std::ptrdiff_t, int>, std::set<int>> strips_of_mark;
        for (const auto& [disc_and_parity, strips] : strips_of_disc) {
            ASSERT_EQ(strips.size(), 1) << "disc " << disc_and_parity.first;
            for (const std::ptrdiff_t segment : marked_by(state, disc_and_parity.first)) {
                strips_of_mark[{segment, disc_and_parity.second}].insert(*strips.begin());
            }
        }
        for (const auto& [mark_and_parity, strips] : strips_of_mark) {
            ASSERT_EQ(strips.size(), 1) << "segment " << mark_and_parity.first;
        }
    }
}

/// Of strips on any number of threads, and of a wavefront of them, one that is said to exceed the cache, too.
template <Policies in_strips> void end_in_the_same_bits(const Scene& scene) {
    constexpr Policies in_wavefront = tests::with(tests::with(in_strips, &Policies::order, Order::wavefront),
                                                  &Policies::resolve_schedule, Schedule::dynamic);
    const tests::Outcome expected = tests::simulate<in_strips>(scene, {.threads = 1});
    const auto is_expected = [&](const tests::Outcome& found) {
        EXPECT_TRUE(same_bits(found.discs, expected.discs));
        EXPECT_EQ(found.work, expected.work);
    };
    for (const int threads : {1, 2, 3, 5, 8, 16}) {
        SCOPED_TRACE(std::to_string(threads) + " threads");
        is_expected(tests::simulate<in_strips>(scene, {.threads = threads, .resolve_chunk = 1}));
        is_expected(tests::simulate<in_wavefront>(scene, {.threads = threads}));
        is_expected(tests::simulate<in_wavefront>(scene, {.threads = threads, .cache_bytes = 0}));
    }
}

TEST(SweepsOverContacts, EndInTheSameBitsAfterTheSameWorkHoweverTheyAreShared) {
    auto scenes = scenes_with_segments();
    scenes.push_back({"crowded", tests::random_scene_of_density(3000, 1.2, 3, 72)});
    for (const auto& [name, scene] : scenes) {
        SCOPED_TRACE(name);
        end_in_the_same_bits<active>(scene);
    }
    end_in_the_same_bits<tests::with(active, &Policies::precision, Precision::float_)>(scenes.back().scene);
}

} // namespace
} // namespace carom

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "kernels/step.hpp"
#include "kernels/tests/definition.hpp"
#include "kernels/tests/scenes.hpp"
#include "kernels/tests/simulate.hpp"

namespace carom {
namespace {

using tests::same_bits;

constexpr Policies wide{.order = Order::strips,
                        .self_contained = SelfContained::off,
                        .storage = Storage::sorted,
                        .overlaps = Overlaps::contacts};
constexpr Policies snug{.neighbourhood = Neighbourhood::nine,
                        .order = Order::strips,
                        .self_contained = SelfContained::off,
                        .storage = Storage::sorted,
                        .box_side = BoxSide::snug,
                        .overlaps = Overlaps::contacts};
constexpr Policies filtered{.neighbourhood = Neighbourhood::nine,
                            .order = Order::strips,
                            .self_contained = SelfContained::off,
                            .storage = Storage::sorted,
                            .box_side = BoxSide::snug,
                            .overlaps = Overlaps::contacts,
                            .search = Search::filtered};
constexpr Policies active{.neighbourhood = Neighbourhood::nine,
                          .order = Order::strips,
                          .self_contained = SelfContained::off,
                          .storage = Storage::sorted,
                          .box_side = BoxSide::snug,
                          .overlaps = Overlaps::contacts,
                          .search = Search::filtered,
                          .worklist = Worklist::active};

using Pairs = std::multiset<std::pair<int, int>>;

template <Policies policies> State<policies> found(const Scene& scene, Tally& tally, int threads = 1) {
    State<policies> state(scene);
    NoProbe probe;
    const Tuning tuning{.threads = threads};
    move(state, tuning, probe);
    bin(state, tuning, probe);
    tally = find(state, tuning, probe);
    return state;
}

/// Overlapping pairs by number, and those of them whose centres do not coincide.
std::pair<Pairs, Pairs> brute_force(const std::vector<Disc>& discs, double radius) {
    Pairs all;
    Pairs with_normal;
    for (int i = 0; i < static_cast<int>(discs.size()); ++i) {
        for (int j = 0; j < i; ++j) {
            const Disc& one = discs[static_cast<std::size_t>(i)];
            const Disc& two = discs[static_cast<std::size_t>(j)];
            const double dx = one.x - two.x;
            const double dy = one.y - two.y;
            if (dx * dx + dy * dy <= 2 * radius * (2 * radius)) {
                all.emplace(j, i);
                if (dx * dx + dy * dy >= coincident_squared<double>) {
                    with_normal.emplace(j, i);
                }
            }
        }
    }
    return {all, with_normal};
}

template <Policies policies> void finds_each_pair_once() {
    for (const auto& [name, scene] : tests::all_scenes()) {
        SCOPED_TRACE(name);
        Tally tally;
        const auto state = found<policies>(scene, tally, 3);
        Pairs pairs;
        for (const auto& strip : state.strips) {
            for (const auto& contact : strip.contacts) {
                const auto [first, second] = contact.discs;
                if (!contact.discs.at_wall()) {
                    ASSERT_LT(first, second);
                    EXPECT_NEAR(std::hypot(contact.normal[0], contact.normal[1]), 1, 1e-15);
                    pairs.insert(std::minmax({state.number(first), state.number(second)}));
                }
            }
        }
        const auto [all, with_normal] = brute_force(discs_by_number(state), scene.radius);
        EXPECT_EQ(pairs, with_normal);
        EXPECT_EQ(tally.overlaps, static_cast<std::int64_t>(all.size()));
    }
}

TEST(Contacts, AreEveryOverlappingPairOnceInWideBoxes) { finds_each_pair_once<wide>(); }
TEST(Contacts, AreEveryOverlappingPairOnceInSnugBoxes) { finds_each_pair_once<snug>(); }
TEST(Contacts, AreEveryOverlappingPairOnceThroughTheFilter) { finds_each_pair_once<filtered>(); }

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
        Tally tally;
        auto state = found<active>(scene, tally);
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
        Tally tally;
        auto state = found<active>(scene, tally);
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

template <Policies policies> void keeps_to_the_definition() {
    for (const tests::NamedScene& named : tests::all_scenes()) {
        SCOPED_TRACE(named.name);
        State<policies> state(named.scene);
        NoProbe probe;
        tests::keeps_to_the_definition(
            named.scene, [&] { return discs_by_number(state); }, [&] { return step(state, {}, probe); });
    }
}

TEST(Contacts, KeepToTheDefinitionOfAStep) {
    keeps_to_the_definition<wide>();
    keeps_to_the_definition<snug>();
    keeps_to_the_definition<filtered>();
    keeps_to_the_definition<active>();
}

template <Policies policies> void depends_on_no_thread(const Scene& scene) {
    const tests::Outcome expected = tests::simulate<policies>(scene, {.threads = 1});
    for (const int threads : {2, 3, 5, 8, 16}) {
        const tests::Outcome found =
            tests::simulate<policies>(scene, {.threads = threads, .resolve_chunk = 1});
        EXPECT_TRUE(same_bits(found.discs, expected.discs)) << threads << " threads";
        EXPECT_EQ(found.work, expected.work) << threads << " threads";
    }
}

template <Policies policies> void depend_on_no_thread_in_any_scene() {
    for (const auto& [name, scene] : tests::all_scenes()) {
        SCOPED_TRACE(name);
        depends_on_no_thread<policies>(scene);
    }
}

TEST(Contacts, DependOnNoThread) { depend_on_no_thread_in_any_scene<wide>(); }

TEST(Contacts, DependOnNoThreadInSnugBoxes) { depend_on_no_thread_in_any_scene<snug>(); }

TEST(Contacts, DependOnNoThreadWithAWorklist) { depend_on_no_thread_in_any_scene<active>(); }

TEST(Contacts, DependOnNoThreadWhereSweepsRunInParallel) {
    depends_on_no_thread<active>(tests::random_scene_of_density(3000, 1.2, 3, 72));
}

TEST(Filter, ChangesNothing) {
    for (const auto& [name, scene] : tests::all_scenes()) {
        SCOPED_TRACE(name);
        const tests::Outcome exact = tests::simulate<snug>(scene);
        const tests::Outcome through_filter = tests::simulate<filtered>(scene);
        EXPECT_TRUE(same_bits(exact.discs, through_filter.discs));
        EXPECT_EQ(exact.work, through_filter.work);
    }
}

/// Sweeps over all contacts once more.
Changes sweep_over_all(State<active>& state) {
    Changes changes;
    const ApproachTolerance approaching(Tolerance::relative);
    for (int row = 0; row < state.grid.boxes_per_side(); ++row) {
        std::fill_n(state.active.row(row), state.active.per_row(), static_cast<unsigned char>(1));
    }
    for (int strip = 0; strip < std::ssize(state.strips); ++strip) {
        changes += resolve_strip(state, strip, approaching);
    }
    return changes;
}

TEST(ActiveWorklist, LeavesOutNothingThatWouldChange) {
    for (const auto& [name, scene] : scenes_with_segments()) {
        SCOPED_TRACE(name);
        State<active> state(scene);
        NoProbe probe;
        for (int k = 0; k < scene.steps; ++k) {
            if (!step(state, {}, probe).settled) {
                break;
            }
            ASSERT_EQ(sweep_over_all(state).count(), 0) << "step " << k;
        }
    }
}

TEST(Wavefront, EndsInTheBitsOfStripsAfterTheSameWork) {
    constexpr Policies in_wavefront = [] {
        Policies policies = active;
        policies.order = Order::wavefront;
        policies.resolve_schedule = Schedule::dynamic;
        return policies;
    }();
    auto scenes = scenes_with_segments();
    scenes.push_back({"crowded", tests::random_scene_of_density(3000, 1.2, 3, 72)});
    for (const auto& [name, scene] : scenes) {
        const tests::Outcome expected = tests::simulate<active>(scene, {.threads = 1});
        for (const int threads : {1, 2, 3, 5, 8, 16}) {
            SCOPED_TRACE(name + ", " + std::to_string(threads) + " threads");
            const tests::Outcome found = tests::simulate<in_wavefront>(scene, {.threads = threads});
            EXPECT_TRUE(same_bits(found.discs, expected.discs));
            EXPECT_EQ(found.work, expected.work);
        }
    }
}

} // namespace
} // namespace carom

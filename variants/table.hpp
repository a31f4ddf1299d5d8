#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

#include "kernels/policies.hpp"
#include "variants/rows.hpp"

namespace carom {

/// Why a combination cannot be, or an empty text.
constexpr std::string_view impossible(const Policies& policies) {
    if (is_sequential(policies.order) && policies.resolve_schedule != Policies{}.resolve_schedule) {
        return "a sequential resolve order has no resolve schedule to choose";
    }
    if (policies.prefetch == Prefetch::on && policies.storage == Storage::sorted) {
        return "sorted discs are read in the order in which they stand: there is nothing to ask ahead for";
    }
    if (policies.box_side == BoxSide::snug && policies.neighbourhood == Neighbourhood::four) {
        return "a quadrant of a snug box does not hold a disc's reach: it needs nine boxes";
    }
    if (policies.box_side == BoxSide::snug &&
        (policies.order == Order::checkered || policies.order == Order::row)) {
        return "two snug boxes of one colour, or rows of one parity, are too near each other";
    }
    if (policies.overlaps == Overlaps::contacts &&
        (policies.storage != Storage::sorted ||
         (policies.order != Order::strips && policies.order != Order::wavefront))) {
        return "contacts are owned by strips of sorted discs";
    }
    if (policies.overlaps == Overlaps::contacts && policies.self_contained == SelfContained::on) {
        return "contacts are resolved by sweeps alone";
    }
    if (policies.overlaps == Overlaps::contacts && policies.direction != Direction::reverse) {
        return "a disc has no list of contacts to choose the way through";
    }
    if (policies.search == Search::filtered && policies.overlaps != Overlaps::contacts) {
        return "only the search for contacts is filtered";
    }
    if (policies.worklist == Worklist::active && policies.overlaps != Overlaps::contacts) {
        return "only contacts can be active; of discs, the order track keeps account";
    }
    if (policies.impact == Impact::at_contact && policies.worklist != Worklist::active) {
        return "only active contacts are taken back to their time: a collision says which to ask anew";
    }
    return "";
}

/// From the published best to the fastest, a policy a rung.
// clang-format off: a rung a line
inline constexpr auto ladder = climb(
    flip(&Policies::storage, Storage::sorted),
    flip(&Policies::order, Order::strips),
    flip(&Policies::self_contained, SelfContained::off),
    flip(&Policies::overlaps, Overlaps::contacts),
    flip(&Policies::neighbourhood, Neighbourhood::nine),
    flip(&Policies::box_side, BoxSide::snug),
    flip(&Policies::search, Search::filtered),
    flip(&Policies::worklist, Worklist::active),
    flip(&Policies::resolve_schedule, Schedule::dynamic),
    flip(&Policies::order, Order::wavefront));
// clang-format on

constexpr Policies at_contact(Policies policies) {
    policies.impact = Impact::at_contact;
    return policies;
}

/// The whole design space, the published best first. A row names what differs from it; one more line is one
/// more variant.
inline constexpr auto table = [] {
    using enum Neighbourhood;
    using enum Order;
    using enum Direction;
    using enum Schedule;
    using enum Precision;
    constexpr auto off = SelfContained::off;
    // clang-format off: a row a line
    return concatenate(
        rows({{}}),
        vary({}, &Policies::neighbourhood, nine),
        vary({}, &Policies::order, row, track, repeat, once),
        vary({}, &Policies::self_contained, off),
        vary({}, &Policies::direction, forward),
        vary({}, &Policies::find_schedule, static_, static_chunk, dynamic, dynamic_chunk, guided),
        vary({}, &Policies::resolve_schedule, static_, static_chunk, dynamic, dynamic_chunk, guided),
        vary({.order = row}, &Policies::resolve_schedule, static_, static_chunk, dynamic, dynamic_chunk, guided),
        vary({.self_contained = off}, &Policies::order, track, repeat, once),
        vary({.direction = forward}, &Policies::order, row, track, repeat, once),
        rows({{.order = row, .self_contained = off, .resolve_schedule = dynamic},
              {.neighbourhood = nine, .order = row, .resolve_schedule = dynamic}}),
        vary({}, &Policies::prefetch, Prefetch::on),
        ladder,
        vary({.precision = float_}, &Policies::neighbourhood, four, nine),
        vary({.precision = float_}, &Policies::order, track),
        rows({{.order = row, .resolve_schedule = dynamic, .precision = float_}}),
        vary(ladder.back(), &Policies::precision, float_),
        vary(at_contact(ladder.back()), &Policies::precision, double_, float_));
    // clang-format on
}();

constexpr bool all_possible() {
    return std::ranges::all_of(table, [](const Policies& policies) { return impossible(policies).empty(); });
}

constexpr bool all_different() {
    for (std::size_t i = 0; i < table.size(); ++i) {
        for (std::size_t k = 0; k < i; ++k) {
            if (table[i] == table[k]) {
                return false;
            }
        }
    }
    return true;
}

static_assert(table[0] == Policies{}, "the published best stands first");
static_assert(all_different(), "a combination of policies stands twice in the table");
static_assert(all_possible(), "a combination in the table cannot be: see impossible()");

} // namespace carom

#pragma once

#include <cstddef>
#include <type_traits>

namespace carom {

/// Which boxes a disc looks into for overlaps.
enum class Neighbourhood {
    nine, ///< its own and all eight around it
    four, ///< its own and the three that its quadrant of the box touches
};

/// The order in which collisions are resolved.
enum class Order {
    checkered, ///< four colours of boxes, one colour in parallel after another
    row,       ///< even rows of boxes in parallel, then odd ones
    track,     ///< one thread; after the first sweep only discs that a later one changed
    repeat,    ///< one thread; every disc in turn, each again and again while it changes
    once,      ///< one thread; every disc in turn, one pass each
    strips,    ///< strips of rows of boxes: even ones in parallel, then odd ones
    wavefront, ///< the same, but a strip waits for those beside it alone, from sweep to sweep
};

/// Whether pairs within one box are resolved already while overlaps are found, until none in it collides.
enum class SelfContained { on, off };

/// The way through a disc's list of overlaps; but for discs that are visited again because another one
/// changed them, whose lists are always gone through from the first (`track`, and within a box).
enum class Direction {
    reverse, ///< from the last found to the first
    forward, ///< from the first found to the last
};

/// How OpenMP hands out the iterations of a parallel loop. `_chunk`: with the chunk of `Tuning`.
enum class Schedule { static_, static_chunk, dynamic, dynamic_chunk, guided, guided_chunk };

/// How the discs stand in memory.
enum class Storage {
    numbered, ///< in the order of their numbers; a box is a growable list of numbers
    sorted,   ///< in the order of their boxes, sorted anew each step; a box is a range
};

/// Whether loops over boxes ask for the memory of the boxes that come next, before they are there. No result
/// depends on it. The published program does not.
enum class Prefetch { off, on };

/// The side of a box of the grid.
enum class BoxSide {
    wide, ///< 4r + 1
    snug, ///< 2r, or the mean distance between discs where that is more
};

/// Where the rest of the scene's side goes, which is less than a box.
enum class Rest {
    in_last_box, ///< the last row and column are wider
    own_box,     ///< a row and a column more, narrower than the others
};

/// What is kept of an overlapping pair.
enum class Overlaps {
    lists,    ///< the other disc's number, in a list of each of the two
    contacts, ///< one contact, with its normal
};

/// How contacts are searched for.
enum class Search {
    exact,    ///< candidate by candidate, in the precision of the discs
    filtered, ///< four candidates at once in float, conservatively; then the exact test of those that remain
};

/// What a sweep looks at.
enum class Worklist {
    all,    ///< everything
    active, ///< contacts of which a disc has changed since they were last looked at
};

/// When a collision happens that is found at the end of a step.
enum class Impact {
    step_end,   ///< then: the discs are where they are, and only their velocities change
    at_contact, ///< when the discs came into contact: they have flown on with their new velocities since
};

/// The floating-point type of positions and velocities.
enum class Precision { double_, float_ };

/// One combination of choices, fixed at compile time. The defaults are the published study's best
/// configuration.
struct Policies {
    Neighbourhood neighbourhood = Neighbourhood::four;
    Order order = Order::checkered;
    SelfContained self_contained = SelfContained::on;
    Direction direction = Direction::reverse;
    Schedule find_schedule = Schedule::guided_chunk;
    Schedule resolve_schedule = Schedule::guided_chunk; ///< of the parallel orders; the others have none
    Storage storage = Storage::numbered;
    Prefetch prefetch = Prefetch::off; ///< of numbered discs; sorted ones are read as they stand
    BoxSide box_side = BoxSide::wide;
    Overlaps overlaps = Overlaps::lists;
    Search search = Search::exact;
    Worklist worklist = Worklist::all;
    Impact impact = Impact::step_end;
    Precision precision = Precision::double_;

    friend constexpr bool operator==(const Policies&, const Policies&) = default;
};

constexpr bool is_sequential(Order order) {
    return order == Order::track || order == Order::repeat || order == Order::once;
}

constexpr bool has_chunk(Schedule schedule) {
    return schedule == Schedule::static_chunk || schedule == Schedule::dynamic_chunk ||
           schedule == Schedule::guided_chunk;
}

/// As in the published programs, of which the one for rows has a grid of its own.
constexpr Rest rest_of(Order order) {
    return order == Order::checkered || is_sequential(order) ? Rest::in_last_box : Rest::own_box;
}

/// Rows of boxes in a strip. Two at least, but for `row`: see resolve_contacts.hpp.
constexpr int strip_height(Order order) { return order == Order::row ? 1 : 4; }

template <Precision precision>
using RealOf = std::conditional_t<precision == Precision::double_, double, float>;

/// Visits to one disc stop after this many passes even if it still changes; the next sweep goes on. It keeps
/// a disc wedged between two walls from holding up the sweep limit.
inline constexpr int passes_per_visit = 100;

/// Within a box discs are visited again in no more than so many rounds.
inline constexpr int rounds_within_box = 1000;

/// Impact::at_contact: so many sweeps at most take collisions back to their time of contact. What is left is
/// resolved at the step's end. Dense scenes in steps of a fifth of a radius need six or seven.
inline constexpr int most_sweeps_at_contact = 16;

/// When an approaching pair counts as colliding.
enum class Tolerance {
    relative,  ///< scale-free, at the level of rounding (see collide.hpp)
    published, ///< 1e-7 absolute, in units of length^2 per time
};

/// What may change at run time without recompiling.
struct Tuning {
    int threads = 1;
    int find_chunk = 4;    ///< boxes or strips, where the find schedule has a chunk
    int resolve_chunk = 5; ///< boxes, rows or strips, where the resolve schedule has a chunk
    int substeps = 1;      ///< dt = 1 / substeps
    Tolerance tolerance = Tolerance::relative;
    std::size_t cache_bytes = 12 << 20; ///< sweeps that touch more follow one another a few strips behind
    int sweep_limit = 100'000;          ///< sweeps in one step after which a resolve is given up as endless
};

} // namespace carom

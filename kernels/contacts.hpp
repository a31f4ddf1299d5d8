#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <span>
#include <vector>

#include "grid.hpp"
#include "policies.hpp"
#include "threads/own_lines.hpp"

namespace carom {

/// Two overlapping discs, the first one before the second in storage order; or a disc at a wall, as both.
struct OverlappingDiscs {
    int first;
    int second;

    bool at_wall() const { return first == second; }
};

/// The same with the unit normal from the first disc to the second. At a wall the normal is NaN: of no motion
/// along it can be said that it does not approach, so that a look needs no question of its own for walls.
template <class Real> struct Contact {
    OverlappingDiscs discs;
    std::array<Real, 2> normal;
};

/// Two discs so near each other that they may have collided within the step; or a disc near a wall, as both.
template <class Real> struct NearPair {
    OverlappingDiscs discs;
    Real last; ///< how long before the end of the step they last collided; infinity if they did not
    Real time; ///< how long before it they came into contact, as they fly now; see at_contact.hpp
};

/// Overlapping discs found so far. A search writes those that it finds beyond the end, where there is room
/// for all that there may be, and then says where the new end is.
class FoundPairs {
  public:
    void clear() { size_ = 0; }

    const OverlappingDiscs* begin() const { return pairs_.data(); }
    const OverlappingDiscs* end() const { return pairs_.data() + size_; }

    /// The end, with room for `more` there.
    OverlappingDiscs* room(int more) {
        const std::size_t needed = size_ + static_cast<std::size_t>(std::max(more, 0));
        if (pairs_.size() < needed) [[unlikely]] {
            pairs_.resize(2 * needed);
        }
        return pairs_.data() + size_;
    }

    void end_at(const OverlappingDiscs* end) {
        size_ = static_cast<std::size_t>(end - pairs_.data());
        assert(size_ <= pairs_.size());
    }

  private:
    OwnVector<OverlappingDiscs> pairs_;
    std::size_t size_ = 0;
};

/// The contacts whose first disc lies in one strip of rows of boxes, in the order of the boxes. The second
/// disc lies in the same strip or in the first row of the next. One thread at a time writes it, while others
/// write those beside it: so all of it has cache lines of its own.
template <class Real> struct alignas(cache_line) Strip {
    OwnVector<Contact<Real>> contacts;
    OwnVector<int> contact_begin;   ///< of each segment, its first contact; at the end, their number
    FoundPairs found;               ///< of one segment, while it is searched
    OwnVector<NearPair<Real>> near; ///< Impact::at_contact: what the search finds, before contacts are made
    OwnVector<int> near_begin;      ///< ditto: of each segment, its first near pair; at the end, their number
    OwnVector<int> pending;         ///< ditto: room for the numbers of all near pairs and one more
    int pending_count = 0;          ///< ditto: how many of them are pending
    OwnVector<int> segments;        ///< room to select segments of one row in
    OwnVector<int> selected;        ///< room to select contacts or near pairs in

    /// Impact::at_contact: the near pairs that have come into contact and have not collided yet.
    std::span<const int> pending_pairs() const {
        return {pending.data(), static_cast<std::size_t>(pending_count)};
    }

    /// Makes room for all that is selected in a sweep over so many near pairs or contacts.
    void make_room(int count, int segments_per_row) {
        selected.resize(static_cast<std::size_t>(count) + 4);
        segments.resize(static_cast<std::size_t>(segments_per_row) + 1);
        pending.resize(near.size() + 1);
        pending_count = 0;
    }
};

/// Of a disc, the earliest of the collisions that are known of it in a sweep.
template <class Real> struct EarliestCollision {
    Real time = 0;     ///< before the end of the step
    int known_in = -1; ///< the sweep in which it is known
};

/// Which segments have contacts to look at: with Worklist::all always all of them. A segment is a run of
/// boxes of one row. Before the first row stands a row of segments that have none, so that every row has one
/// before it.
class ActiveSegments {
  public:
    static constexpr int boxes_per_segment = 16;

    explicit ActiveSegments(int boxes_per_side)
        : per_row_((boxes_per_side + boxes_per_segment - 1) / boxes_per_segment),
          stride_((per_row_ + cache_line - 1) / cache_line * cache_line), last_column_(boxes_per_side - 1),
          marks_(static_cast<std::size_t>(stride_) * (static_cast<std::size_t>(boxes_per_side) + 1)) {}

    int per_row() const { return per_row_; }

    /// The mark of the first segment of a row; those of the row's other segments follow.
    unsigned char* row(int row) { return marks_.data() + static_cast<std::ptrdiff_t>(row + 1) * stride_; }

    /// Of a disc, the marks of its own segment and of those that the boxes beside its own lie in: two at
    /// most, and the same one twice for most discs.
    struct Beside {
        int left;
        int right;
    };

    /// The same for every column of a segment.
    struct Segment {
        int mark;
        int left_edge; ///< the column whose left neighbour lies in another segment, or -1
        int right_edge;

        Beside beside(int column) const {
            return {mark - static_cast<int>(column == left_edge),
                    mark + static_cast<int>(column == right_edge)};
        }
    };

    /// `columns` are those of the segment.
    Segment segment(int row, BoxRange columns) const {
        return {.mark = (row + 1) * stride_ + columns.first / boxes_per_segment,
                .left_edge = columns.first > 0 ? columns.first : -1,
                .right_edge = columns.last < last_column_ ? columns.last : -1};
    }

    /// Marks segments. A copy of what that takes, which can stay in registers: a byte may alias anything, so
    /// that after a store through it the members would be loaded again.
    struct Marker {
        unsigned char* marks;
        std::ptrdiff_t stride;

        /// Marks every segment that can hold a contact of that disc: as the first one, in its own box; as the
        /// second, in the box to the left or one of the three below. (The box to the right can hold none, but
        /// to leave it out would take longer.)
        void mark(Beside beside) const {
            assert(beside.left >= stride && beside.right >= stride);
            unsigned char* const below = marks - stride;
            marks[beside.left] = 1;
            marks[beside.right] = 1;
            below[beside.left] = 1;
            below[beside.right] = 1;
        }
    };
    Marker marker() { return {marks_.data(), stride_}; }

  private:
    int per_row_;
    int stride_; ///< of rows, so that no two threads write to one cache line at a time
    int last_column_;
    UntouchedVector<unsigned char> marks_; ///< those of a row are written first by who searches its strip
};

} // namespace carom

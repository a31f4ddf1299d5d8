#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "grid.hpp"
#include "policies.hpp"

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

/// The contacts whose first disc lies in one strip of rows of boxes, in the order of the boxes. The second
/// disc lies in the same strip or in the first row of the next.
template <class Real> struct Strip {
    std::vector<Contact<Real>> contacts;
    std::vector<int> first; ///< of each block of boxes, its first contact; at the end, their number
    std::vector<OverlappingDiscs> found; ///< of one block, while it is searched
    std::vector<int> colliding; ///< which contacts may collide, while they are resolved; room for one more
};

/// Which blocks of boxes have contacts to look at again, for Worklist::active. A block is a run of boxes of
/// one row. Before the first row stands a row of blocks that have none, so that every row has one before it.
class ActiveBlocks {
  public:
    static constexpr int boxes_per_block = 16;

    explicit ActiveBlocks(int boxes_per_side)
        : per_row_((boxes_per_side + boxes_per_block - 1) / boxes_per_block),
          last_column_(boxes_per_side - 1),
          marks_(static_cast<std::size_t>(per_row_) * (static_cast<std::size_t>(boxes_per_side) + 1)) {}

    int per_row() const { return per_row_; }

    /// The mark of the first block of a row; those of the row's other blocks, and of the next rows', follow.
    unsigned char* row(int row) { return marks_.data() + static_cast<std::ptrdiff_t>(row + 1) * per_row_; }

    /// The codes of a block's boxes: the block, and whether the boxes beside, if any, lie in other ones.
    struct Codes {
        int block;
        int left_edge; ///< the column whose left neighbour lies in another block, or -1
        int right_edge;

        int operator()(int column) const {
            return block * 4 + static_cast<int>(column == right_edge) * 2 +
                   static_cast<int>(column == left_edge);
        }
    };

    /// `columns` are those of the block.
    Codes codes(int row, BoxRange columns) const {
        return {.block = (row + 1) * per_row_ + columns.first / boxes_per_block,
                .left_edge = columns.first > 0 ? columns.first : -1,
                .right_edge = columns.last < last_column_ ? columns.last : -1};
    }

    /// Marks blocks. Apart from the rest so that it can be copied into registers: nobody knows what else a
    /// store of bytes may change.
    struct Marker {
        unsigned char* marks;
        std::ptrdiff_t per_row;

        /// Marks every block that can hold a contact of a disc in the box of that code: as the first disc, in
        /// its own; as the second, in that of the box to the left and of the three boxes below.
        void mark(int code) const {
            const int left = code & 1;
            const int right = code >> 1 & 1;
            unsigned char* own = marks + (code >> 2);
            unsigned char* below = own - per_row;
            own[0] = 1;
            own[-left] = 1;
            below[-left] = 1;
            below[right] = 1;
        }
    };
    Marker marker() { return {marks_.data(), per_row_}; }

  private:
    int per_row_;
    int last_column_;
    std::vector<unsigned char> marks_;
};

} // namespace carom

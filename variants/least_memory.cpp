#include "variants/least_memory.hpp"

#include <array>
#include <cstddef>
#include <vector>

#include "kernels/contacts.hpp"
#include "kernels/exact/flight.hpp"
#include "kernels/exact/tile_history.hpp"
#include "kernels/grid.hpp"
#include "kernels/state.hpp"
#include "variants/event_driven_variant.hpp"

namespace carom {
namespace {

/// Of a thread's stack and heap, as measured, without what it works on.
constexpr std::int64_t bytes_per_thread = 32 << 10;

/// Adds up the elements of vectors.
class Bytes {
  public:
    template <class Element> void add(std::int64_t count) {
        bytes_ += count * static_cast<std::int64_t>(sizeof(Element));
    }
    std::int64_t sum() const { return bytes_; }

  private:
    std::int64_t bytes_ = 0;
};

/// As DiscsOf has them (kernels/storage.hpp).
template <class Real>
void add_discs(Bytes& bytes, const Policies& policies, std::int64_t discs, std::int64_t boxes, int threads) {
    if (policies.storage == Storage::numbered) {
        bytes.add<BasicDisc<Real>>(discs);
        bytes.add<std::vector<int>>(boxes);
        bytes.add<int>(discs);
        return;
    }
    bytes.add<BasicDisc<Real>>(2 * discs);
    bytes.add<int>(4 * discs); // numbers and boxes, and their spare
    bytes.add<int>(boxes);
    bytes.add<int>(threads > 1 ? discs : 0);
    bytes.add<float>(policies.search == Search::filtered ? 2 * discs : 0);
}

/// As OverlapsOf has them (kernels/state.hpp).
template <class Real> void add_overlaps(Bytes& bytes, const Policies& policies, std::int64_t discs) {
    const std::int64_t at_contact = policies.impact == Impact::at_contact ? discs : 0;
    if (policies.overlaps == Overlaps::lists) {
        bytes.add<std::vector<int>>(discs);
        bytes.add<unsigned char>(discs + 2 * at_contact);
        bytes.add<std::vector<NearDisc<Real>>>(at_contact);
        bytes.add<NextCollision<Real>>(at_contact);
        return;
    }
    bytes.add<ActiveSegments::Beside>(policies.worklist == Worklist::active ? discs : 0);
    bytes.add<EarliestCollision<Real>>(at_contact);
    bytes.add<int>(at_contact);
}

template <class Real>
std::int64_t of_steps(const Policies& policies, const Scene& box, std::int64_t discs, int threads) {
    const Grid grid(box.side, box.radius, static_cast<int>(discs), policies.box_side);
    Bytes bytes;
    add_discs<Real>(bytes, policies, discs, grid.box_count(), threads);
    add_overlaps<Real>(bytes, policies, discs);
    return bytes.sum();
}

} // namespace

std::int64_t least_memory(const Variant& variant, const Scene& box, std::int64_t discs, int threads) {
    Bytes bytes;
    bytes.add<Disc>(discs);
    if (variant.engine == Engine::event_driven) {
        const bool in_tiles = tiles_for(static_cast<std::size_t>(discs), threads).all() > 1;
        bytes.add<Flight<double>>((in_tiles ? 2 : 1) * discs); // now, and as the window began
        bytes.add<Held>(in_tiles ? discs : 0);
        bytes.add<std::array<double, 2>>(discs); // in the queue
        return bytes.sum();
    }
    const std::int64_t steps = variant.policies.precision == Precision::float_
                                   ? of_steps<float>(variant.policies, box, discs, threads)
                                   : of_steps<double>(variant.policies, box, discs, threads);
    return bytes.sum() + steps + threads * bytes_per_thread;
}

} // namespace carom

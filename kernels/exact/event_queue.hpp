#pragma once

#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace carom {

/// For each of N discs the time of its next event; the earliest is found at once, and a change costs O(log
/// N). A binary heap that knows where each disc stands in it, so that it never grows.
template <class Real> class EventQueue {
  public:
    explicit EventQueue(int count) : place_(static_cast<std::size_t>(count)) {
        for (int disc = 0; disc < count; ++disc) {
            heap_.push_back({std::numeric_limits<Real>::infinity(), disc});
            place_[static_cast<std::size_t>(disc)] = heap_.size() - 1;
        }
    }

    bool empty() const { return heap_.empty(); }
    int earliest() const { return heap_.front().disc; }
    Real earliest_time() const { return heap_.front().time; }

    /// Gives the disc's next event another time.
    void set(int disc, Real time) {
        const std::size_t place = place_[static_cast<std::size_t>(disc)];
        const bool sooner = time < heap_[place].time;
        heap_[place].time = time;
        if (sooner) {
            rise(place);
        } else {
            sink(place);
        }
    }

  private:
    struct Entry {
        Real time;
        int disc;
    };

    void put(std::size_t place, const Entry& entry) {
        heap_[place] = entry;
        place_[static_cast<std::size_t>(entry.disc)] = place;
    }

    void rise(std::size_t place) {
        const Entry entry = heap_[place];
        while (place > 0 && entry.time < heap_[(place - 1) / 2].time) {
            put(place, heap_[(place - 1) / 2]);
            place = (place - 1) / 2;
        }
        put(place, entry);
    }

    void sink(std::size_t place) {
        const Entry entry = heap_[place];
        for (std::size_t child = 2 * place + 1; child < heap_.size(); child = 2 * place + 1) {
            if (child + 1 < heap_.size() && heap_[child + 1].time < heap_[child].time) {
                ++child;
            }
            if (!(heap_[child].time < entry.time)) {
                break;
            }
            put(place, heap_[child]);
            place = child;
        }
        put(place, entry);
    }

    std::vector<Entry> heap_;
    std::vector<std::size_t> place_;
};

} // namespace carom

#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

namespace carom {

/// For each of N discs the time of its next event, the earliest first; those of one instant come in the order
/// of their discs. To find the earliest and to change a time takes as long for any N, on average and as long
/// as events keep coming about as often.
///
/// A calendar (Brown, Communications of the ACM 31, 1220, 1988; for collisions Paul, J. Comput. Phys. 221,
/// 615, 2007): the time ahead is divided into buckets of one width, each a list of discs in any order, which
/// is sorted when time comes near. Nothing is ever taken out of a list: that a disc has another time by now
/// is noticed when its entry comes up. When all buckets have been opened a new year begins, of all discs'
/// times, with buckets as wide as would have made for `per_bucket` entries each in the last year. It begins
/// early where much has been done to keep in order what has been opened, as with buckets much too wide.
template <class Real> class EventQueue {
  public:
    /// So many of those after the earliest are known, as a rule.
    static constexpr std::size_t ahead = 3;

    explicit EventQueue(int count)
        : times_(static_cast<std::size_t>(count), never), buckets_(times_.size() / 8 + 1) {
        for (auto& bucket : buckets_) {
            bucket.reserve(2 * per_bucket);
        }
    }

    /// Forgets all events and is as at the start, but for the memory it has.
    void clear() {
        std::ranges::fill(times_, never);
        for (auto& bucket : buckets_) {
            bucket.clear();
        }
        opened_ = static_cast<Real>(buckets_.size());
        soon_.clear();
        front_ = 0;
        year_begin_ = 0;
        buckets_per_time_ = never;
        now_ = 0;
        added_ = 0;
        shifted_ = 0;
    }

    /// The time of the earliest event; infinity if there is none.
    Real earliest_time() {
        if (added_ + shifted_ > 16 * times_.size() + 1000) {
            begin_year();
        }
        while (soon_.size() - front_ <= ahead || is_stale(soon_[front_])) {
            if (front_ < soon_.size() && is_stale(soon_[front_])) {
                ++front_;
            } else if (!open_bucket()) {
                break;
            }
        }
        now_ = front_ < soon_.size() ? soon_[front_].time : never;
        return now_;
    }

    /// The disc of the event whose time earliest_time() has just told, if there is one.
    int earliest() const { return soon_[front_].disc; }

    /// Probably the disc of the event `count` after that one, at most `ahead`, if nothing changes.
    int coming(std::size_t count) const { return soon_[std::min(front_ + count, soon_.size() - 1)].disc; }

    /// Gives the disc's next event another time.
    void set(int disc, Real time) {
        times_[static_cast<std::size_t>(disc)] = time;
        add(disc, time);
    }

    /// Asks for what set() will read.
    [[gnu::always_inline]] void prefetch(int disc) const {
        __builtin_prefetch(&times_[static_cast<std::size_t>(disc)]);
    }

  private:
    static constexpr std::size_t per_bucket = 16;
    static constexpr Real never = std::numeric_limits<Real>::infinity();

    struct Entry {
        Real time;
        int disc;

        bool operator<(const Entry& other) const {
            return time < other.time || (time == other.time && disc < other.disc);
        }
    };

    Real time_of(int disc) const { return times_[static_cast<std::size_t>(disc)]; }
    bool is_stale(const Entry& entry) const { return entry.time != time_of(entry.disc); }

    /// Rounded down it is the number of a bucket. It never falls as time grows, whatever the rounding.
    Real bucket_at(Real time) const { return (time - year_begin_) * buckets_per_time_; }

    void add(int disc, Real time) {
        const Real bucket = bucket_at(time);
        ++added_;
        if (bucket < opened_) {
            soon_.push_back({time, disc});
            std::size_t place = soon_.size() - 1;
            for (; place > front_ && soon_[place] < soon_[place - 1]; --place) {
                std::swap(soon_[place], soon_[place - 1]);
                ++shifted_;
            }
        } else if (bucket < static_cast<Real>(buckets_.size())) {
            buckets_[static_cast<std::size_t>(bucket)].push_back(disc);
        }
    }

    /// Puts what the next bucket holds behind what comes soon; false if there is no such bucket.
    bool open_bucket() {
        soon_.erase(soon_.begin(), soon_.begin() + static_cast<std::ptrdiff_t>(front_));
        front_ = 0;
        if (opened_ == static_cast<Real>(buckets_.size()) && !(soon_.empty() && begin_year())) {
            return false;
        }
        const auto before = static_cast<std::ptrdiff_t>(soon_.size());
        std::vector<int>& discs = buckets_[static_cast<std::size_t>(opened_)];
        for (const int disc : discs) {
            const Real bucket = bucket_at(time_of(disc));
            if (bucket >= opened_ && bucket < opened_ + 1) {
                soon_.push_back({time_of(disc), disc});
            }
        }
        discs.clear();
        std::sort(soon_.begin() + before, soon_.end());
        opened_ += 1;
        return true;
    }

    /// Begins with the earliest event; false if there is none.
    bool begin_year() {
        const auto earliest = std::min_element(times_.begin(), times_.end());
        if (earliest == times_.end() || *earliest == never) {
            return false;
        }
        const Real per_time = static_cast<Real>(added_) / per_bucket / (now_ - year_begin_);
        const bool is_known = per_time > 0 && per_time < never;
        buckets_per_time_ = is_known ? per_time : std::numeric_limits<Real>::min(); // all in the first bucket
        year_begin_ = *earliest;
        opened_ = 0;
        soon_.clear();
        front_ = 0;
        for (auto& bucket : buckets_) {
            bucket.clear();
        }
        for (int disc = 0; disc < static_cast<int>(times_.size()); ++disc) {
            add(disc, time_of(disc));
        }
        added_ = 0;
        shifted_ = 0;
        return true;
    }

    std::vector<Real> times_;
    std::vector<std::vector<int>> buckets_;
    Real opened_ = static_cast<Real>(buckets_.size()); ///< how many
    std::vector<Entry> soon_;                          ///< what has been opened, from front_ on in order
    std::size_t front_ = 0;
    Real year_begin_ = 0;
    Real buckets_per_time_ = never;
    Real now_ = 0;            ///< the time told last
    std::size_t added_ = 0;   ///< entries since the year began
    std::size_t shifted_ = 0; ///< by how many places, in sum, since then
};

} // namespace carom

#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace carom {

/// For each of N discs the time of its next event and who else has part in it, the earliest first. Those of
/// one instant come in the order of the lower, then of the higher of their two numbers, whichever of the two
/// the event is of; a disc's number is its place, unless the discs have been given others. To find the
/// earliest and to change a time takes as long for any N, on average and as long as events keep coming about
/// as often.
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

    explicit EventQueue(int count = 0) { clear(count); }

    /// Forgets all events and is as one of so many discs at the start, but for the memory it has.
    void clear(int count) {
        numbers_ = {};
        events_.assign(static_cast<std::size_t>(count), Event{});
        buckets_.resize(events_.size() / 8 + 1);
        for (auto& bucket : buckets_) {
            bucket.clear();
            bucket.reserve(2 * per_bucket);
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

    /// Orders events of one instant by these numbers of the discs from now on, and makes room for as many
    /// discs. The queue does not keep a copy.
    void number(std::span<const int> numbers) {
        numbers_ = numbers;
        events_.resize(std::max(events_.size(), numbers.size()));
    }

    /// The time of the earliest event; infinity if there is none.
    Real earliest_time() {
        if (added_ + shifted_ > 16 * events_.size() + 1000) {
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

    /// Gives the disc another next event, at that time and with that one: another disc, itself, or -1, so
    /// that it comes before all others of its instant.
    void set(int disc, Real time, int other) {
        events_[static_cast<std::size_t>(disc)] = {time, other};
        add({{time, other}, disc});
    }

    /// Asks for what set() will read.
    [[gnu::always_inline]] void prefetch(int disc) const {
        __builtin_prefetch(&events_[static_cast<std::size_t>(disc)]);
    }

  private:
    static constexpr std::size_t per_bucket = 16;
    static constexpr Real never = std::numeric_limits<Real>::infinity();

    struct Event {
        Real time = never;
        int other = 0;

        bool operator==(const Event&) const = default;
    };

    struct Entry : Event {
        int disc;
    };

    bool is_before(const Entry& one, const Entry& two) const {
        return one.time < two.time || (one.time == two.time && ranks(one) < ranks(two));
    }

    [[gnu::noinline]] std::array<int, 3> ranks(const Entry& one) const {
        const int disc = number_of(one.disc);
        const int other = number_of(one.other);
        return {std::min(disc, other), std::max(disc, other), disc};
    }

    int number_of(int disc) const {
        return disc < 0 || numbers_.empty() ? disc : numbers_[static_cast<std::size_t>(disc)];
    }

    const Event& event_of(int disc) const { return events_[static_cast<std::size_t>(disc)]; }
    bool is_stale(const Entry& entry) const { return entry != event_of(entry.disc); }

    /// Rounded down it is the number of a bucket. It never falls as time grows, whatever the rounding.
    Real bucket_at(Real time) const { return (time - year_begin_) * buckets_per_time_; }

    void add(const Entry& entry) {
        const Real bucket = bucket_at(entry.time);
        ++added_;
        if (bucket < opened_) {
            soon_.push_back(entry);
            std::size_t place = soon_.size() - 1;
            for (; place > front_ && is_before(soon_[place], soon_[place - 1]); --place) {
                std::swap(soon_[place], soon_[place - 1]);
                ++shifted_;
            }
        } else if (bucket < static_cast<Real>(buckets_.size())) {
            buckets_[static_cast<std::size_t>(bucket)].push_back(entry.disc);
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
            const Real bucket = bucket_at(event_of(disc).time);
            if (bucket >= opened_ && bucket < opened_ + 1) {
                soon_.push_back({event_of(disc), disc});
            }
        }
        discs.clear();
        std::sort(soon_.begin() + before, soon_.end(),
                  [this](const Entry& one, const Entry& two) { return is_before(one, two); });
        opened_ += 1;
        return true;
    }

    /// Begins with the earliest event; false if there is none.
    bool begin_year() {
        const auto is_earlier = [](const Event& one, const Event& other) { return one.time < other.time; };
        const auto earliest = std::min_element(events_.begin(), events_.end(), is_earlier);
        if (earliest == events_.end() || earliest->time == never) {
            return false;
        }
        const Real per_time = static_cast<Real>(added_) / per_bucket / (now_ - year_begin_);
        const bool is_known = per_time > 0 && per_time < never;
        buckets_per_time_ = is_known ? per_time : std::numeric_limits<Real>::min(); // all in the first bucket
        year_begin_ = earliest->time;
        opened_ = 0;
        soon_.clear();
        front_ = 0;
        for (auto& bucket : buckets_) {
            bucket.clear();
        }
        for (int disc = 0; disc < static_cast<int>(events_.size()); ++disc) {
            add({event_of(disc), disc});
        }
        added_ = 0;
        shifted_ = 0;
        return true;
    }

    std::span<const int> numbers_;
    std::vector<Event> events_; ///< the next one of each disc
    std::vector<std::vector<int>> buckets_;
    Real opened_ = 0;         ///< how many
    std::vector<Entry> soon_; ///< what has been opened, from front_ on in order
    std::size_t front_ = 0;
    Real year_begin_ = 0;
    Real buckets_per_time_ = never;
    Real now_ = 0;            ///< the time told last
    std::size_t added_ = 0;   ///< entries since the year began
    std::size_t shifted_ = 0; ///< by how many places, in sum, since then
};

} // namespace carom

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "harness/support/process_clock.hpp"
#include "kernels/parallel_for.hpp"
#include "kernels/policies.hpp"
#include "kernels/probe.hpp"

namespace carom {

inline constexpr std::array all_phases{Phase::move, Phase::bin, Phase::find, Phase::resolve};
inline constexpr std::size_t phase_count = all_phases.size();

/// What one thread did in one phase, summed over all steps.
struct ThreadWork {
    double busy_seconds = 0; ///< in iterations of parallel loops; for the master also in serial code
    double waiting_seconds =
        0; ///< at barriers, for other iterations or any, and while the master runs serial code
    std::int64_t iterations = 0;
    std::int64_t chunks = 0;
    std::int64_t loops = 0;
};

struct PhaseTime {
    double wall_seconds = 0;
    double serial_seconds = 0; ///< of it, outside parallel loops
};

/// A stretch of time on one thread, for the timeline. Seconds since the profile began.
struct Span {
    enum class Kind { phase, sweep, loop, wait, chunk };
    Kind kind;
    Phase phase;
    double begin;
    double end;
    std::int64_t first = 0; ///< of a chunk: its first iteration
    std::int64_t count = 0; ///< of a chunk: how many
};

/// What of the timeline to keep. A profiler that has kept `most_spans` leaves out the rest and counts it.
struct TimelineOptions {
    bool spans = false;
    bool chunks = false;
    std::size_t most_spans = 300'000;
};

/// A probe that times phases, loops and barriers on every thread and counts iterations and chunks.
///
/// A chunk begins where a thread's iterations are not consecutive, and, where the schedule fixes the chunk
/// (static or dynamic), at each multiple of it. Under a guided schedule chunks that one thread takes one
/// right after another count as one: OpenMP does not tell where they meet.
class Profiler final : public Probe {
  public:
    /// `policies` and `tuning` tell the chunks of each phase's loops.
    Profiler(const Policies& policies, const Tuning& tuning, TimelineOptions timeline)
        : tracks_(static_cast<std::size_t>(tuning.threads)), timeline_(timeline),
          most_spans_per_thread_(timeline.most_spans / static_cast<std::size_t>(tuning.threads)),
          start_(process_seconds()) {
        fixed_chunk_[static_cast<std::size_t>(Phase::find)] =
            fixed_chunk(policies.find_schedule, tuning.find_chunk);
        fixed_chunk_[static_cast<std::size_t>(Phase::resolve)] =
            fixed_chunk(policies.resolve_schedule, tuning.resolve_chunk);
    }

    void phase_begin(Phase phase) override {
        phase_ = phase;
        phase_begin_ = now();
        for (Track& track : tracks_) {
            track.last_event = phase_begin_;
        }
    }

    void phase_end(Phase phase) override {
        const double end = now();
        for (int thread = 0; thread < threads(); ++thread) {
            note_gap(thread, end);
        }
        phases_[static_cast<std::size_t>(phase)].wall_seconds += end - phase_begin_;
        keep(track(0), {.kind = Span::Kind::phase, .phase = phase, .begin = phase_begin_, .end = end});
    }

    void sweep_begin() override { sweep_begin_ = now(); }

    void sweep_end() override {
        keep(track(0), {.kind = Span::Kind::sweep, .phase = phase_, .begin = sweep_begin_, .end = now()});
    }

    void loop_begin(int thread) override {
        Track& one = track(thread);
        const double begin = now();
        note_gap(thread, begin);
        one.loop_begin = begin;
        one.waited = 0;
        one.next_index = -1;
        one.iterations_before = current(one).iterations;
        ++current(one).loops;
    }

    void wait_begin(int thread) override {
        Track& one = track(thread);
        one.wait_begin = now();
        if (timeline_.chunks) {
            keep_chunk(one, one.wait_begin);
        }
        one.next_index = -1;
    }

    void wait_end(int thread) override {
        Track& one = track(thread);
        const double end = now();
        one.waited += end - one.wait_begin;
        keep(one, {.kind = Span::Kind::wait, .phase = phase_, .begin = one.wait_begin, .end = end});
    }

    void iteration(int thread, int index) override {
        Track& one = track(thread);
        ThreadWork& work = current(one);
        ++work.iterations;
        const std::optional<int> chunk = fixed_chunk_[static_cast<std::size_t>(phase_)];
        if (index != one.next_index || (chunk && index % *chunk == 0)) {
            ++work.chunks;
            if (timeline_.chunks) {
                const double begin = now();
                keep_chunk(one, begin);
                one.chunk_begin = begin;
                one.chunk_first = index;
            }
        }
        one.next_index = index + 1;
    }

    void loop_end(int thread) override {
        Track& one = track(thread);
        if (current(one).iterations == one.iterations_before) {
            one.loop_end = one.loop_begin; // it got nothing, and has waited for the others from the beginning
            return;
        }
        one.loop_end = now();
        if (timeline_.chunks) {
            keep_chunk(one, one.loop_end);
        }
        current(one).busy_seconds += one.loop_end - one.loop_begin - one.waited;
        current(one).waiting_seconds += one.waited;
        keep(one, {.kind = Span::Kind::loop, .phase = phase_, .begin = one.loop_begin, .end = one.loop_end});
    }

    void barrier_end(int thread) override {
        Track& one = track(thread);
        one.last_event = now();
        current(one).waiting_seconds += one.last_event - one.loop_end;
        keep(one, {.kind = Span::Kind::wait, .phase = phase_, .begin = one.loop_end, .end = one.last_event});
    }

    int threads() const { return static_cast<int>(tracks_.size()); }
    const PhaseTime& phase_time(Phase phase) const { return phases_[static_cast<std::size_t>(phase)]; }
    const ThreadWork& work(Phase phase, int thread) const {
        return tracks_[static_cast<std::size_t>(thread)].work[static_cast<std::size_t>(phase)];
    }

    /// The spans of one thread, in the order in which they ended.
    const std::vector<Span>& spans(int thread) const {
        return tracks_[static_cast<std::size_t>(thread)].spans;
    }

    std::size_t spans_left_out() const {
        std::size_t total = 0;
        for (const Track& track : tracks_) {
            total += track.left_out;
        }
        return total;
    }

  private:
    /// What one thread writes; a cache line apart from the others'.
    struct alignas(cache_line) Track {
        std::array<ThreadWork, phase_count> work;
        std::vector<Span> spans;
        std::size_t left_out = 0;
        double last_event = 0; ///< the end of the last barrier, or the beginning of the phase
        double loop_begin = 0;
        double loop_end = 0;
        double wait_begin = 0;
        double waited = 0; ///< in the loop, for other iterations
        double chunk_begin = 0;
        std::int64_t chunk_first = 0;
        std::int64_t next_index = -1;
        std::int64_t iterations_before = 0; ///< the loop, in this phase
    };

    /// The chunk that the schedule fixes in advance, if it does.
    static std::optional<int> fixed_chunk(Schedule schedule, int chunk) {
        if (schedule == Schedule::dynamic) {
            return 1;
        }
        if (schedule == Schedule::static_chunk || schedule == Schedule::dynamic_chunk) {
            return chunk;
        }
        return std::nullopt;
    }

    double now() const { return process_seconds() - start_; }

    Track& track(int thread) { return tracks_[static_cast<std::size_t>(thread)]; }
    ThreadWork& current(Track& track) { return track.work[static_cast<std::size_t>(phase_)]; }
    void keep(Track& track, const Span& span) const {
        if (!timeline_.spans) {
            return;
        }
        if (track.spans.size() < most_spans_per_thread_) {
            track.spans.push_back(span);
        } else {
            ++track.left_out;
        }
    }

    void keep_chunk(Track& track, double end) {
        if (track.next_index >= 0) {
            keep(track, {.kind = Span::Kind::chunk,
                         .phase = phase_,
                         .begin = track.chunk_begin,
                         .end = end,
                         .first = track.chunk_first,
                         .count = track.next_index - track.chunk_first});
        }
    }

    /// Between parallel loops the master runs serial code and the others wait.
    void note_gap(int thread, double until) {
        Track& one = track(thread);
        const double gap = until - one.last_event;
        if (thread == 0) {
            current(one).busy_seconds += gap;
            phases_[static_cast<std::size_t>(phase_)].serial_seconds += gap;
        } else {
            current(one).waiting_seconds += gap;
        }
        one.last_event = until;
    }

    std::vector<Track> tracks_;
    std::array<PhaseTime, phase_count> phases_{};
    std::array<std::optional<int>, phase_count> fixed_chunk_;
    TimelineOptions timeline_;
    std::size_t most_spans_per_thread_;
    Phase phase_ = Phase::move;
    double phase_begin_ = 0;
    double sweep_begin_ = 0;
    double start_ = 0;
};

} // namespace carom

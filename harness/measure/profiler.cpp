#include "harness/measure/profiler.hpp"

#include "harness/support/process_clock.hpp"

namespace carom {
namespace {

/// The chunk that the schedule fixes in advance, if it does.
std::optional<int> fixed_chunk(Schedule schedule, int chunk) {
    if (schedule == Schedule::dynamic) {
        return 1;
    }
    if (schedule == Schedule::static_chunk || schedule == Schedule::dynamic_chunk) {
        return chunk;
    }
    return std::nullopt;
}

} // namespace

Profiler::Profiler(const Policies& policies, const Tuning& tuning, TimelineOptions timeline)
    : tracks_(static_cast<std::size_t>(tuning.threads)), timeline_(timeline),
      most_spans_per_thread_(timeline.most_spans / static_cast<std::size_t>(tuning.threads)),
      start_(process_seconds()) {
    fixed_chunk_[static_cast<std::size_t>(Phase::find)] =
        fixed_chunk(policies.find_schedule, tuning.find_chunk);
    fixed_chunk_[static_cast<std::size_t>(Phase::resolve)] =
        fixed_chunk(policies.resolve_schedule, tuning.resolve_chunk);
}

double Profiler::now() const { return process_seconds() - start_; }

const ThreadWork& Profiler::work(Phase phase, int thread) const {
    return tracks_[static_cast<std::size_t>(thread)].work[static_cast<std::size_t>(phase)];
}

const std::vector<Span>& Profiler::spans(int thread) const {
    return tracks_[static_cast<std::size_t>(thread)].spans;
}

std::size_t Profiler::spans_left_out() const {
    std::size_t total = 0;
    for (const Track& track : tracks_) {
        total += track.left_out;
    }
    return total;
}

void Profiler::keep(Track& track, const Span& span) const {
    if (!timeline_.spans) {
        return;
    }
    if (track.spans.size() < most_spans_per_thread_) {
        track.spans.push_back(span);
    } else {
        ++track.left_out;
    }
}

/// Between parallel loops the master runs serial code and the others wait.
void Profiler::note_gap(int thread, double until) {
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

void Profiler::phase_begin(Phase phase) {
    phase_ = phase;
    phase_begin_ = now();
    for (Track& track : tracks_) {
        track.last_event = phase_begin_;
    }
}

void Profiler::phase_end(Phase phase) {
    const double end = now();
    for (int thread = 0; thread < threads(); ++thread) {
        note_gap(thread, end);
    }
    phases_[static_cast<std::size_t>(phase)].wall_seconds += end - phase_begin_;
    keep(track(0), {.kind = Span::Kind::phase, .phase = phase, .begin = phase_begin_, .end = end});
}

void Profiler::sweep_begin() { sweep_begin_ = now(); }

void Profiler::sweep_end() {
    keep(track(0), {.kind = Span::Kind::sweep, .phase = phase_, .begin = sweep_begin_, .end = now()});
}

void Profiler::loop_begin(int thread) {
    Track& one = track(thread);
    const double begin = now();
    note_gap(thread, begin);
    one.loop_begin = begin;
    one.waited = 0;
    one.next_index = -1;
    one.iterations_before = current(one).iterations;
    ++current(one).loops;
}

void Profiler::wait_begin(int thread) {
    Track& one = track(thread);
    one.wait_begin = now();
    if (timeline_.chunks) {
        keep_chunk(one, one.wait_begin);
    }
    one.next_index = -1;
}

void Profiler::wait_end(int thread) {
    Track& one = track(thread);
    const double end = now();
    one.waited += end - one.wait_begin;
    keep(one, {.kind = Span::Kind::wait, .phase = phase_, .begin = one.wait_begin, .end = end});
}

void Profiler::iteration(int thread, int index) {
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

void Profiler::keep_chunk(Track& track, double end) {
    if (track.next_index >= 0) {
        keep(track, {.kind = Span::Kind::chunk,
                     .phase = phase_,
                     .begin = track.chunk_begin,
                     .end = end,
                     .first = track.chunk_first,
                     .count = track.next_index - track.chunk_first});
    }
}

void Profiler::loop_end(int thread) {
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

void Profiler::barrier_end(int thread) {
    Track& one = track(thread);
    one.last_event = now();
    current(one).waiting_seconds += one.last_event - one.loop_end;
    keep(one, {.kind = Span::Kind::wait, .phase = phase_, .begin = one.loop_end, .end = one.last_event});
}

} // namespace carom

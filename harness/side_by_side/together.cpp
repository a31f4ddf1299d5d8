#include "harness/side_by_side/together.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <functional>
#include <numeric>
#include <random>
#include <thread>
#include <utility>

#include "harness/side_by_side/contender_run.hpp"
#include "harness/side_by_side/slices.hpp"
#include "harness/side_by_side/stopping.hpp"

namespace carom {
namespace {

using Indices = std::vector<std::size_t>;

constexpr double seconds_of_rounds = 1;

/// What is known of all contenders while they are measured.
class Contest {
  public:
    Contest(const std::vector<ProgramContender>& contenders, const Together& how)
        : contenders_(contenders), how_(how), random_(how.seed), measured_(contenders.size()),
          undisturbed_(contenders.size()) {}

    std::vector<Measured> measure() {
        each_in_random_order([this](std::size_t k) { warm_up(k); });
        if (sliceable().size() > 1) {
            each_in_random_order([this](std::size_t k) { look_at(k); });
        }
        first_round();
        further_rounds();
        return std::move(measured_);
    }

  private:
    bool is_open(std::size_t k) const { return measured_[k].runs.empty() && measured_[k].failure.empty(); }

    bool may_be_sliced(std::size_t k) const {
        return !contenders_[k].times_itself && contenders_[k].turns.value_or(true);
    }

    bool is_to_be_found_out(std::size_t k) const { return may_be_sliced(k) && !contenders_[k].turns; }

    void each_in_random_order(const std::function<void(std::size_t)>& act) {
        Indices order(contenders_.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::ranges::shuffle(order, random_);
        std::ranges::for_each(order, act);
    }

    /// A whole run without a pause. Nothing if it failed, which is then what became of the contender.
    std::optional<ProcessEnd> run(std::size_t k) {
        ContenderRun one(contenders_[k]);
        if (one.can_run()) {
            one.process().advance(1e9);
        }
        measured_[k].failure = one.conclude();
        return measured_[k].failure.empty() ? std::optional(one.process().end()) : std::nullopt;
    }

    void warm_up(std::size_t k) {
        for (int count = 0; count < contenders_[k].warm_ups && is_open(k); ++count) {
            run(k);
        }
    }

    void keep(std::size_t k, const ProcessEnd& end) {
        measured_[k].failure = contenders_[k].take(end);
        if (measured_[k].failure.empty()) {
            measured_[k].runs.push_back(end);
        }
    }

    void keep_undisturbed(std::size_t k, const ProcessEnd& end, const std::string& why) {
        measured_[k].undisturbed = why;
        keep(k, end);
    }

    /// A first run of what nobody knows.
    void look_at(std::size_t k) {
        if (!is_open(k) || !is_to_be_found_out(k)) {
            return;
        }
        const double idle_before = idle_seconds_of_machine();
        const auto end = run(k);
        if (!end) {
            return;
        }
        const double idle_processors = (idle_seconds_of_machine() - idle_before) / end->wall_seconds();
        const std::string idle = why_idle(*end, idle_processors);
        if (idle.empty()) {
            undisturbed_[k].push_back(*end);
        } else {
            keep_undisturbed(k, *end, idle);
        }
    }

    Indices sliceable() const {
        Indices found;
        for (std::size_t k = 0; k < contenders_.size(); ++k) {
            if (is_open(k) && may_be_sliced(k)) {
                found.push_back(k);
            }
        }
        return found;
    }

    void first_round() {
        const Indices sliced = sliceable().size() > 1 ? sliceable() : Indices();
        std::vector<std::function<void()>> stretches;
        if (!sliced.empty()) {
            stretches.emplace_back([this, &sliced] { take_turns(sliced); });
        }
        for (std::size_t k = 0; k < contenders_.size(); ++k) {
            if (is_open(k) && std::ranges::find(sliced, k) == sliced.end()) {
                stretches.emplace_back([this, k] { stretch(k); });
            }
        }
        std::ranges::shuffle(stretches, random_);
        for (const auto& one : stretches) {
            one();
        }
    }

    /// Of one that is left over from those that were to take turns, the undisturbed run is there already.
    void stretch(std::size_t k) {
        if (!undisturbed_[k].empty()) {
            keep_undisturbed(k, undisturbed_[k].front(), "nothing was left that it could take turns with");
        } else if (const auto end = run(k)) {
            keep(k, *end);
        }
    }

    double expected(std::size_t k) const {
        return undisturbed_[k].empty() ? contenders_[k].expected_seconds
                                       : undisturbed_[k].back().wall_seconds();
    }

    /// All of them in slices, once more where it turns out that their lengths were not known.
    void take_turns(const Indices& sliced) {
        std::vector<double> lengths;
        std::ranges::transform(sliced, std::back_inserter(lengths), [this](auto k) { return expected(k); });
        std::vector<SlicedRun> runs = run_in_slices(sliced, lengths);
        const bool were_known = std::ranges::all_of(lengths, [](double length) { return length > 0; });
        const bool ended = std::ranges::all_of(runs, [](const auto& one) { return one.failure.empty(); });
        if (!were_known && ended && ended_apart(runs)) {
            std::ranges::transform(runs, lengths.begin(), [](auto& one) { return one.end.wall_seconds(); });
            runs = run_in_slices(sliced, lengths);
        }
        for (std::size_t at = 0; at < sliced.size(); ++at) {
            judge(sliced[at], runs[at]);
        }
    }

    struct SlicedRun {
        ProcessEnd end;
        std::string failure;
        double seconds_alone = 0;
    };

    static bool ended_apart(const std::vector<SlicedRun>& runs) {
        return std::ranges::any_of(
            runs, [](const auto& one) { return one.seconds_alone > 0.1 * one.end.wall_seconds(); });
    }

    std::vector<SlicedRun> run_in_slices(const Indices& sliced, const std::vector<double>& lengths) {
        std::deque<ContenderRun> runs;
        std::vector<Sliced> slices;
        std::vector<std::size_t> places;
        for (std::size_t at = 0; at < sliced.size(); ++at) {
            ContenderRun& one = runs.emplace_back(contenders_[sliced[at]]);
            if (one.can_run()) {
                slices.push_back({.process = &one.process(), .expected_seconds = lengths[at]});
                places.push_back(at);
            }
        }
        take_slices(slices, how_.slice_seconds, random_());
        std::vector<SlicedRun> ended(sliced.size());
        for (std::size_t n = 0; n < places.size(); ++n) {
            ended[places[n]].end = slices[n].process->end();
            ended[places[n]].seconds_alone = slices[n].seconds_alone;
        }
        for (std::size_t at = 0; at < sliced.size(); ++at) {
            ended[at].failure = runs[at].conclude();
        }
        return ended;
    }

    /// Whether a run in slices may stand.
    void judge(std::size_t k, const SlicedRun& run_in_turns) {
        if (undisturbed_[k].empty() || !run_in_turns.failure.empty()) {
            judge_failure(k, run_in_turns);
            return;
        }
        std::vector<ProcessEnd> in_slices{run_in_turns.end};
        while (may_disagree(undisturbed_[k], in_slices) && in_slices.size() < runs_to_be_sure) {
            const auto alone = run(k);
            const auto paused = alone ? run_with_pauses(k, mean_slice(run_in_turns.end)) : std::nullopt;
            if (!paused) {
                return;
            }
            undisturbed_[k].push_back(*alone);
            in_slices.push_back(*paused);
        }
        if (may_disagree(undisturbed_[k], in_slices)) {
            keep_undisturbed(k, undisturbed_[k].back(), how_they_disagree(undisturbed_[k], in_slices));
        } else {
            keep_sliced(k, run_in_turns);
        }
    }

    void judge_failure(std::size_t k, const SlicedRun& run_in_turns) {
        if (run_in_turns.failure.empty()) {
            keep_sliced(k, run_in_turns);
        } else if (undisturbed_[k].empty()) {
            measured_[k].failure = run_in_turns.failure + hint_of_slices(run_in_turns.end);
        } else {
            keep_undisturbed(k, undisturbed_[k].front(),
                             "it fails where it is stopped now and then (" + run_in_turns.failure + ")");
        }
    }

    void keep_sliced(std::size_t k, const SlicedRun& run_in_turns) {
        measured_[k].sliced = true;
        measured_[k].seconds_alone = run_in_turns.seconds_alone;
        keep(k, run_in_turns.end);
    }

    static double mean_slice(const ProcessEnd& end) {
        return end.wall_seconds() / static_cast<double>(end.seconds.size());
    }

    /// In slices as long as those that it had, with pauses as if others took turns with it.
    std::optional<ProcessEnd> run_with_pauses(std::size_t k, double slice_seconds) {
        ContenderRun one(contenders_[k]);
        while (one.can_run() && !one.process().has_ended()) {
            one.process().advance(slice_seconds);
            std::this_thread::sleep_for(
                std::chrono::duration<double>(one.process().has_ended() ? 0 : how_.slice_seconds));
        }
        const std::string failure = one.conclude();
        if (!failure.empty()) {
            keep_undisturbed(k, undisturbed_[k].back(),
                             "it fails where it is stopped now and then (" + failure + ")");
            return std::nullopt;
        }
        return one.process().end();
    }

    void further_rounds() {
        double longest = 0;
        int rounds = 1;
        for (std::size_t k = 0; k < contenders_.size(); ++k) {
            if (contenders_[k].most_rounds > 1 && measured_[k].failure.empty()) {
                longest = std::max(longest, measured_[k].runs.front().wall_seconds());
                rounds = std::max(rounds, contenders_[k].most_rounds);
            }
        }
        const double wanted = longest > 0 ? std::ceil(seconds_of_rounds / longest) : 1;
        for (int round = 1; round < std::min(static_cast<double>(rounds), wanted); ++round) {
            each_in_random_order([this, round](std::size_t k) {
                if (round < contenders_[k].most_rounds && measured_[k].failure.empty()) {
                    if (const auto end = run(k)) {
                        keep(k, *end);
                    }
                }
            });
        }
    }

    const std::vector<ProgramContender>& contenders_;
    const Together& how_;
    std::mt19937_64 random_;
    std::vector<Measured> measured_;
    std::vector<std::vector<ProcessEnd>>
        undisturbed_; ///< of those that are looked at, the runs without a pause
};

} // namespace

std::vector<Measured> measure_together(const std::vector<ProgramContender>& contenders, const Together& how) {
    return Contest(contenders, how).measure();
}

} // namespace carom

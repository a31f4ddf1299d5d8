#include "harness/side_by_side/together.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <map>
#include <numeric>
#include <random>
#include <utility>

#include "harness/processes/priority.hpp"
#include "harness/side_by_side/contender_run.hpp"
#include "harness/side_by_side/slices.hpp"
#include "harness/side_by_side/stopping.hpp"
#include "harness/support/text.hpp"

namespace carom {
namespace {

using Indices = std::vector<std::size_t>;

constexpr double seconds_of_rounds = 1;

/// Bytes of what a run has printed: enough to know what kind of program did it.
constexpr std::size_t end_kept = 4096;

constexpr const char* left_alone = "nothing was left that it could take turns with";

/// What is known of all contenders while they are measured.
class Contest {
  public:
    Contest(const std::vector<ProgramContender>& contenders, const Together& how)
        : contenders_(contenders), how_(how), random_(how.seed), measured_(contenders.size()),
          undisturbed_(contenders.size()), in_slices_(contenders.size()) {}

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
    struct SlicedRun {
        ProcessEnd end;
        std::string failure;
        double seconds_alone = 0;
    };

    bool is_open(std::size_t k) const { return measured_[k].runs.empty() && measured_[k].failure.empty(); }

    bool may_be_sliced(std::size_t k) const {
        return !contenders_[k].times_itself && !contenders_[k].rounds && contenders_[k].turns.value_or(true);
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
            // Of many runs these would fill the memory.
            std::string& printed = measured_[k].runs.back().output.end;
            printed.erase(0, printed.size() - std::min(printed.size(), end_kept));
            measured_[k].runs.back().error.end = last_line(measured_[k].runs.back().error.end);
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

    /// Whether it has several runs or one, those of each are spread evenly over the whole, at random within
    /// an even share.
    void first_round() {
        const Indices sliced = sliceable().size() > 1 ? sliceable() : Indices();
        std::multimap<double, std::function<void()>> stretches;
        std::uniform_real_distribution<double> share;
        if (!sliced.empty()) {
            stretches.emplace(share(random_), [this, &sliced] { take_turns(sliced); });
        }
        for (std::size_t k = 0; k < contenders_.size(); ++k) {
            if (!is_open(k) || std::ranges::find(sliced, k) != sliced.end()) {
                continue;
            }
            const int rounds = contenders_[k].rounds.value_or(1);
            for (int round = 0; round < rounds; ++round) {
                stretches.emplace((round + share(random_)) / rounds, [this, k] { stretch(k); });
            }
        }
        for (const auto& [when, run_it] : stretches) {
            run_it();
        }
    }

    /// Of one that is left over from those that were to take turns, the undisturbed run is there already.
    void stretch(std::size_t k) {
        if (!undisturbed_[k].empty()) {
            keep_undisturbed(k, undisturbed_[k].front(), left_alone);
        } else if (const auto end = measured_[k].failure.empty() ? run(k) : std::nullopt) {
            keep(k, *end);
        }
    }

    double expected(std::size_t k) const {
        return undisturbed_[k].empty() ? contenders_[k].expected_seconds
                                       : undisturbed_[k].back().wall_seconds();
    }

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

    /// In slices, once more where it turns out that their lengths were not known.
    std::vector<SlicedRun> run_in_known_slices(const Indices& sliced) {
        std::vector<double> lengths;
        std::ranges::transform(sliced, std::back_inserter(lengths), [this](auto k) { return expected(k); });
        std::vector<SlicedRun> runs = run_in_slices(sliced, lengths);
        const bool were_known = std::ranges::all_of(lengths, [](double length) { return length > 0; });
        const bool ended = std::ranges::all_of(runs, [](const auto& one) { return one.failure.empty(); });
        if (!were_known && ended && ended_apart(runs)) {
            std::ranges::transform(runs, lengths.begin(), [](auto& one) { return one.end.wall_seconds(); });
            runs = run_in_slices(sliced, lengths);
        }
        return runs;
    }

    /// All of them in slices, and all again while one takes another time than undisturbed: that may be noise,
    /// or it waits for one of the others, which stands still then.
    void take_turns(Indices group) {
        std::size_t attempts = 0;
        do {
            const std::vector<SlicedRun> runs = run_in_known_slices(group);
            for (std::size_t at = 0; at < group.size(); ++at) {
                in_slices_[group[at]].push_back(runs[at]);
                judge_failure(group[at], runs[at]);
            }
            if (++attempts < runs_to_be_sure) {
                std::ranges::for_each(group, [&](auto k) { look_again(k, attempts - 1); });
            }
            std::erase_if(group, [this](auto k) { return !is_open(k); });
        } while (attempts < runs_to_be_sure && group.size() > 1 && !all_agree(group, attempts - 1));
        judge(group, attempts);
    }

    void look_again(std::size_t k, std::size_t attempt) {
        if (const auto end = is_open(k) && disagrees(k, attempt) ? run(k) : std::nullopt) {
            undisturbed_[k].push_back(*end);
        }
    }

    bool disagrees(std::size_t k, std::size_t attempt) const {
        return !undisturbed_[k].empty() && may_disagree(undisturbed_[k], {in_slices_[k][attempt].end});
    }

    bool all_agree(const Indices& group, std::size_t attempt) const {
        return std::ranges::none_of(group, [&](auto k) { return disagrees(k, attempt); });
    }

    /// Which runs in slices may stand: those of an attempt in which all agree. Where there is none, nobody's
    /// that disagreed in any: which of two that wait for one another has to is chance.
    void judge(Indices group, std::size_t attempts) {
        std::size_t attempt = 0;
        while (attempt + 1 < attempts && !all_agree(group, attempt)) {
            ++attempt;
        }
        if (!all_agree(group, attempt)) {
            std::erase_if(group, [this](auto k) { return is_to_be_undisturbed(k); });
            if (group.size() == 1 && !undisturbed_[group.front()].empty()) {
                stretch(group.front());
                return;
            }
        }
        for (const std::size_t k : group) {
            measured_[k].sliced = true;
            measured_[k].seconds_alone = in_slices_[k][attempt].seconds_alone;
            keep(k, in_slices_[k][attempt].end);
        }
    }

    /// Keeps its undisturbed run if it disagreed in any attempt.
    bool is_to_be_undisturbed(std::size_t k) {
        std::vector<ProcessEnd> apart;
        for (std::size_t attempt = 0; attempt < in_slices_[k].size(); ++attempt) {
            if (disagrees(k, attempt)) {
                apart.push_back(in_slices_[k][attempt].end);
            }
        }
        if (!apart.empty()) {
            keep_undisturbed(k, undisturbed_[k].back(), how_they_disagree(undisturbed_[k], apart));
        }
        return !apart.empty();
    }

    /// Of one that failed in slices, what became of it.
    void judge_failure(std::size_t k, const SlicedRun& run_in_turns) {
        if (run_in_turns.failure.empty()) {
            return;
        }
        if (undisturbed_[k].empty()) {
            measured_[k].failure = run_in_turns.failure;
        } else {
            keep_undisturbed(k, undisturbed_[k].back(),
                             "a run in slices failed (" + run_in_turns.failure +
                                 "), one without a pause did not");
        }
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
                if (round < contenders_[k].most_rounds) {
                    stretch(k);
                }
            });
        }
    }

    const std::vector<ProgramContender>& contenders_;
    const Together& how_;
    std::mt19937_64 random_;
    std::vector<Measured> measured_;
    std::vector<std::vector<ProcessEnd>>
        undisturbed_;                               ///< of those that are looked at, the runs without a pause
    std::vector<std::vector<SlicedRun>> in_slices_; ///< of those that take turns, one for each attempt
};

} // namespace

std::vector<Measured> measure_together(const std::vector<ProgramContender>& contenders, const Together& how) {
    run_at_once();
    return Contest(contenders, how).measure();
}

} // namespace carom

#pragma once

#include <optional>
#include <vector>

#include "harness/accuracy/choice.hpp"
#include "harness/accuracy/error_measures.hpp"
#include "harness/accuracy/trial.hpp"
#include "kernels/scene.hpp"
#include "kernels/state.hpp"

namespace carom {

/// A whole run of a method: what it costs, setting up included, and how wrong it is.
struct Delivered {
    Method method;
    double seconds = 0; ///< the least of several runs, in turns with those of the others
    double error = 0;   ///< not a number where it cannot be told
};

/// What the choice for a bound promised, what its run delivered, and what would have cost least.
struct Promise {
    double bound = 0;
    Measure measure = Measure::path;
    Tried promised;
    double trial_seconds = 0; ///< that it took to choose
    Delivered delivered;
    Delivered cheapest; ///< of all methods whose whole run keeps the bound; the chosen one if none does
    int methods = 0;    ///< that were timed

    bool is_kept() const { return delivered.error <= bound; }

    /// How many times as much the chosen one costs as the cheapest.
    double cost_ratio() const { return delivered.seconds / cheapest.seconds; }
};

/// The error of a whole run by that measure; not a number where there is none.
double error_of(const ErrorMeasures& errors, Measure measure);

/// Keeps promises on one scene, to see what becomes of them.
class Promises {
  public:
    /// What is given must outlive it. The discs must be apart at the start, and the scene have a unit of
    /// time.
    Promises(const Scene& scene, const Tuning& tuning, const Costs& costs);

    /// Chooses a method as try_methods does, runs the whole scene with it, and with every other one as far as
    /// it takes hardly longer; measures the errors of those; and times the ones that keep the bound, and the
    /// chosen one, in turns. Nothing if the trial finds no method for the bound. Throws CheckError as
    /// try_methods and measure_errors do.
    std::optional<Promise> keep(Measure measure, double bound);

  private:
    struct Measured {
        Method method;
        ErrorMeasures errors;
    };

    double time_run(const Method& method, double most) const;
    double error_of_run(const Method& method, Measure measure);
    std::vector<Delivered> rivals_of(const Promise& promise);

    const Scene& scene_;
    const Tuning& tuning_;
    const Costs& costs_;
    std::vector<Method> methods_;
    std::vector<Measured> measured_; ///< every error of a run is measured at once
};

} // namespace carom

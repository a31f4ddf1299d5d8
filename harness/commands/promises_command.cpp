#include <algorithm>
#include <iostream>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/accuracy/promise.hpp"
#include "harness/command_line/values.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/error_bound.hpp"
#include "harness/commands/measurement_options.hpp"
#include "harness/machine/provenance.hpp"
#include "harness/machine/suspensions.hpp"
#include "harness/machine/threads.hpp"
#include "harness/records/record.hpp"
#include "harness/support/format.hpp"
#include "harness/support/json.hpp"
#include "harness/support/output_file.hpp"
#include "harness/support/process_clock.hpp"
#include "harness/support/text.hpp"

namespace carom {
namespace {

struct PromisesOptions {
    std::string scene;
    Tuning tuning{.threads = default_threads()};
    std::vector<double> bounds{0.1, 0.01, 0.001, 1e-6};
    std::vector<std::string> measures;
    std::string record;
    std::vector<std::string> tags;
};

nlohmann::ordered_json delivered_json(const Delivered& delivered) {
    return {{"variant", delivered.method.variant->name},
            {"substeps", delivered.method.substeps},
            {"seconds", delivered.seconds},
            {"error", number_or_null(delivered.error)}};
}

/// What was asked for, and the promise that was made; none where no method is known to keep it.
struct Asked {
    ErrorBound bound;
    std::optional<Promise> promise;

    bool is_kept() const { return promise && promise->is_kept(); }
};

nlohmann::ordered_json asked_json(const Asked& asked) {
    nlohmann::ordered_json json{{"measure", text_of(asked.bound.measure).word},
                                {"error_below", asked.bound.below},
                                {"promised", nullptr},
                                {"trial_seconds", nullptr},
                                {"methods", nullptr},
                                {"chosen", nullptr},
                                {"cheapest", nullptr}};
    if (asked.promise) {
        json["promised"] = asked.promise->promised.largest_error();
        json["trial_seconds"] = asked.promise->trial_seconds;
        json["methods"] = asked.promise->methods;
        json["chosen"] = delivered_json(asked.promise->delivered);
        json["cheapest"] = delivered_json(asked.promise->cheapest);
    }
    return json;
}

nlohmann::ordered_json promises_json(const PromisesOptions& options, const LoadedScene& loaded,
                                     const std::vector<Asked>& asked) {
    auto promises = nlohmann::ordered_json::array();
    std::ranges::transform(asked, std::back_inserter(promises), asked_json);
    return record_of("promises", options.tags,
                     {{"axes", {{"threads", options.tuning.threads}}},
                      {"scene", scene_json(loaded.scene, loaded.name, loaded.sha256)},
                      {"promises", promises},
                      {"process_seconds", process_seconds()},
                      {"provenance", provenance_json(options.tuning.threads)}});
}

void print_asked(const Asked& asked) {
    std::cout << format("  %-14s %8g ", text_of(asked.bound.measure).word, asked.bound.below);
    if (!asked.promise) {
        std::cout << "no method is known to reach it\n";
        return;
    }
    const Promise& promise = *asked.promise;
    const bool is_cheapest = promise.cheapest.method == promise.delivered.method;
    std::cout << format("%10.2g %10.2g  %-6s %10.4g %8.2f  %s", promise.promised.largest_error(),
                        promise.delivered.error, promise.is_kept() ? "kept" : "broken",
                        1e3 * promise.delivered.seconds, promise.cost_ratio(),
                        text_of(promise.delivered.method).c_str())
              << (is_cheapest ? "" : "; cheapest: " + text_of(promise.cheapest.method)) << '\n';
}

/// What is asked for, in the order in which measures stand in the help.
std::vector<ErrorBound> bounds_of(const PromisesOptions& options) {
    std::vector<ErrorBound> bounds;
    for (const auto& [word, measure] : measure_choices()) {
        if (options.measures.empty() || std::ranges::count(options.measures, word) > 0) {
            for (const double below : options.bounds) {
                bounds.push_back({.below = below, .measure = measure});
            }
        }
    }
    return bounds;
}

void keep_promises(const PromisesOptions& options) {
    tags_json(options.tags);
    require_writable(options.record);
    const LoadedScene loaded = load_scene(options.scene);
    const auto bounds = bounds_of(options);
    require_exact_run(loaded.scene, bounds.front());
    std::cout << format(
        "%s: %s, %s of time, %s\n", loaded.name.c_str(), counted(loaded.scene.discs.size(), "disc").c_str(),
        counted(loaded.scene.steps, "unit").c_str(), counted(options.tuning.threads, "thread").c_str());
    std::cout << "  error of          below   promised  delivered             run ms    times  chosen\n";
    Suspensions suspensions;
    suspensions.start();
    const Costs costs = costs_of_machine();
    Promises promises(loaded.scene, options.tuning, costs);
    std::vector<Asked> asked;
    for (const ErrorBound& bound : bounds) {
        asked.push_back({.bound = bound, .promise = promises.keep(bound.measure, bound.below)});
        print_asked(asked.back());
    }
    suspensions.require_none(loaded.name);
    std::cout << format("  kept %d of %d\n", static_cast<int>(std::ranges::count_if(asked, &Asked::is_kept)),
                        static_cast<int>(asked.size()));
    if (!options.record.empty()) {
        write_record(options.record, promises_json(options, loaded, asked));
    }
}

} // namespace

void add_promises_command(CLI::App& program) {
    auto options = std::make_shared<PromisesOptions>();
    CLI::App* command =
        program.add_subcommand("promises", "Test whether the choice of `run --error-below` stays below its "
                                           "bound, and whether another one costs less");
    add_scene_option(*command, options->scene);
    add_number(*command, "--threads", options->tuning.threads, 1, most_threads, "OpenMP threads");
    command->add_option("--error-below", options->bounds, "Bound of the error; may be repeated")
        ->check(positive_number())
        ->type_name("X")
        ->allow_extra_args(false);
    std::vector<std::string> words;
    for (const auto& [word, measure] : measure_choices()) {
        words.push_back(word);
    }
    take_one_of(command->add_option("--measure", options->measures,
                                    "Which error; may be repeated; by default every one"),
                words)
        ->allow_extra_args(false);
    add_record_options(*command, options->record, options->tags);
    command->callback([options] { keep_promises(*options); });
}

} // namespace carom

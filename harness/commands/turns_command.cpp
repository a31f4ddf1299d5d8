#include <algorithm>
#include <cstdint>
#include <deque>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "harness/command_line/usage_errors.hpp"
#include "harness/command_line/values.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/measurement_options.hpp"
#include "harness/commands/simulation_options.hpp"
#include "harness/machine/suspensions.hpp"
#include "harness/machine/threads.hpp"
#include "harness/measure/turns.hpp"
#include "harness/measure/variant_contender.hpp"
#include "harness/records/record.hpp"
#include "harness/support/errors.hpp"
#include "harness/support/input_file.hpp"
#include "harness/support/output_file.hpp"
#include "harness/support/process_clock.hpp"
#include "harness/support/text.hpp"

namespace carom {
namespace {

struct TurnsOptions {
    std::string file;
    std::string record;
    std::vector<std::string> right_ends;
    double turn_seconds = 0.002;
    int runs = 1;
    std::uint64_t seed = 1;
    bool counts = false;
};

/// What one contender's words say.
struct ContenderOptions {
    SimulationOptions simulation;
    MeasurementOptions measurement;
    int repetitions = 1;
};

/// Parses one contender's words. Throws InputError with `where` in front.
ContenderOptions parse_contender(const std::vector<std::string>& words, const std::string& where) {
    ContenderOptions options;
    CLI::App parser("", "carom bench");
    parser.set_help_flag();
    add_simulation_options(parser, options.simulation);
    add_measurement_options(parser, options.measurement);
    parser.remove_option(parser.get_option("--record"));
    parser.add_option("--repetitions", options.repetitions)->check(one_of({"1"}));
    try {
        parser.parse(std::vector<std::string>(words.rbegin(), words.rend()));
    } catch (const CLI::ParseError& error) {
        throw InputError(where + ": " + usage_message(parser, error));
    }
    if (options.simulation.variant != automatic) {
        require_variant(options.simulation.variant);
    }
    require_threads(options.simulation.tuning.threads);
    tags_json(options.measurement.tags);
    return options;
}

/// Reads a JSON list with a list of words for each contender. Throws InputError.
std::vector<ContenderOptions> read_contenders(const std::string& path) {
    const auto json = nlohmann::json::parse(read_file(path), nullptr, false);
    const auto is_words = [](const auto& words) {
        return words.is_array() &&
               std::ranges::all_of(words, [](const auto& word) { return word.is_string(); });
    };
    if (!json.is_array() || json.empty() || !std::ranges::all_of(json, is_words)) {
        throw InputError(path + ": found something else, expected a JSON list with a list of words, as for "
                                "`carom bench`, for each contender");
    }
    std::vector<ContenderOptions> contenders;
    for (const auto& words : json) {
        contenders.push_back(parse_contender(words.template get<std::vector<std::string>>(),
                                             path + ", contender " + std::to_string(contenders.size() + 1)));
    }
    return contenders;
}

/// The measurement that one contender's words ask for. `scene` must outlive it.
Measurement measurement_of(const LoadedScene& scene, const ContenderOptions& said) {
    const Tuning& tuning = said.simulation.tuning;
    return measurement_of(
        scene, require_variant(said.simulation.variant, scene.scene, tuning, said.simulation.library), tuning,
        said.measurement, said.simulation.library);
}

/// Lets them run; returns how, as the record has it.
nlohmann::ordered_json compete(std::deque<VariantContender>& contenders, const TurnsOptions& options) {
    std::vector<double> expected;
    std::vector<Contender*> everyone;
    int fewest_steps = contenders.front().steps();
    for (VariantContender& one : contenders) {
        expected.push_back(one.prepare());
        everyone.push_back(&one);
        fewest_steps = std::min(fewest_steps, one.steps());
    }
    const TurnsPlan plan{.runs = options.runs,
                         .rounds = count_rounds(expected, fewest_steps, options.turn_seconds),
                         .seed = options.seed};
    return turns_json(plan, take_turns(everyone, plan));
}

/// Contenders as the record has them, and what is wrong with the first of which something is.
struct Measured {
    nlohmann::ordered_json contenders = nlohmann::ordered_json::array();
    nlohmann::ordered_json turns = nullptr;
    std::optional<std::string> failure;

    void add(const Measurement& measurement) {
        contenders.push_back(contender_json(measurement));
        if (measurement.violation && !failure) {
            failure = measurement.name() + ": " + *measurement.violation;
        }
    }
};

Measured take_turns(const std::vector<ContenderOptions>& said, const TurnsOptions& options) {
    std::map<std::string, LoadedScene> scenes;
    std::set<std::string> right_ends(options.right_ends.begin(), options.right_ends.end());
    std::deque<VariantContender> contenders;
    for (const ContenderOptions& one : said) {
        const std::string& path = one.simulation.scene;
        auto loaded = scenes.find(path);
        if (loaded == scenes.end()) {
            loaded = scenes.emplace(path, load_scene(path)).first;
        }
        contenders.emplace_back(measurement_of(loaded->second, one), right_ends);
    }
    Suspensions suspensions;
    suspensions.start();
    Measured measured;
    measured.turns = compete(contenders, options);
    suspensions.require_none("turns of " + counted(contenders.size(), "contender"));
    for (VariantContender& one : contenders) {
        one.finish(options.runs);
        measured.add(one.measurement());
    }
    return measured;
}

/// One after the other, each gone before the next begins.
Measured count(const std::vector<ContenderOptions>& said) {
    std::optional<LoadedScene> scene;
    std::string path;
    Measured measured;
    Suspensions suspensions;
    suspensions.start();
    for (const ContenderOptions& one : said) {
        const double start = process_seconds();
        if (!scene || path != one.simulation.scene) {
            path = one.simulation.scene;
            scene = load_scene(path);
        }
        Measurement measurement = measurement_of(*scene, one);
        measurement.warm_ups = 0;
        measurement.add(measurement.run_alone(measurement.scope));
        measurement.own_seconds = process_seconds() - start;
        suspensions.require_none(measurement.name());
        measured.add(measurement);
    }
    return measured;
}

void turns(const TurnsOptions& options) {
    require_writable(options.record);
    const std::vector<ContenderOptions> said = read_contenders(options.file);
    const Measured measured = options.counts ? count(said) : take_turns(said, options);
    write_record(options.record, "bench", measured.contenders, said.front().simulation.tuning.threads,
                 measured.turns);
    if (measured.failure) {
        throw CheckError(*measured.failure);
    }
}

} // namespace

void add_turns_command(CLI::App& program) {
    auto options = std::make_shared<TurnsOptions>();
    CLI::App* command = program.add_subcommand(
        "turns", "Time several variants, scenes or tunings side by side, some steps of each in turn");
    command
        ->add_option(
            "CONTENDERS", options->file,
            "JSON file: a list with, for each contender, a list of the words that `carom bench` would be "
            "given, but for --record")
        ->required();
    command->add_option("--record", options->record, "File for the record of all of them")->required();
    add_number(*command, "--turn", options->turn_seconds, 1e-6, 1e6,
               "Seconds that a turn is to last, a step at least");
    add_number(*command, "--runs", options->runs, 1, 1'000'000,
               "Whole runs of each contender, all in turns; all start again together");
    add_number(*command, "--seed", options->seed, 0, std::numeric_limits<std::uint64_t>::max(),
               "Of the order of the turns");
    command->add_option("--right-ends", options->right_ends,
                        "Hashes of final states (state_hash of a record) that need no check: it was passed");
    command
        ->add_flag("--counts", options->counts,
                   "Only count the work: no turns and nothing warmed up, one contender after the other, each "
                   "in memory alone; those of one scene should follow one another")
        ->excludes(command->get_option("--turn"))
        ->excludes(command->get_option("--runs"))
        ->excludes(command->get_option("--seed"))
        ->excludes(command->get_option("--right-ends"));
    command->callback([options] { turns(*options); });
}

} // namespace carom

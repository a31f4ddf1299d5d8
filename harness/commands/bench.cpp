#include <algorithm>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "harness/accuracy/error_measures.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/measurement_options.hpp"
#include "harness/commands/simulation_options.hpp"
#include "harness/machine/provenance.hpp"
#include "harness/machine/threads.hpp"
#include "harness/measure/bench_case.hpp"
#include "harness/records/record.hpp"
#include "harness/support/errors.hpp"

namespace carom {
namespace {

struct BenchOptions {
    std::vector<std::string> scenes;
    std::vector<std::string> variants{"published"};
    std::vector<int> threads;
    MeasurementOptions measurement;
    Tuning tuning;
    int repetitions = 0;
    bool errors = false;
};

void require_one_case(const BenchOptions& options) {
    if (options.scenes.size() * options.variants.size() * options.threads.size() != 1) {
        throw InputError("--record: found several scenes, variants or thread counts, expected one of each");
    }
}

/// Hands the --benchmark_* flags to Google Benchmark; whatever it does not know is an error.
void initialize(const std::vector<std::string>& flags) {
    static std::string program = "carom"; // Google Benchmark keeps the pointer and prints it much later
    std::vector<std::string> texts;
    for (const std::string& flag : flags) {
        if (flag.starts_with("--benchmark_perf_counters")) {
            throw InputError(
                flag + ": Google Benchmark as packaged is built without libpfm and would count nothing; "
                       "`carom profile --counters` counts through PAPI");
        }
        if (!flag.starts_with("--benchmark_")) {
            throw InputError("found '" + flag +
                             "', expected an option of `carom bench --help` or a --benchmark_* flag");
        }
        texts.push_back(flag);
    }
    std::vector<char*> pointers{program.data()};
    for (std::string& text : texts) {
        pointers.push_back(text.data());
    }
    int count = static_cast<int>(pointers.size());
    benchmark::Initialize(&count, pointers.data());
    if (count > 1) {
        throw InputError("found '" + std::string(pointers[1]) +
                         "', expected a flag that Google Benchmark knows");
    }
    const auto provenance = provenance_json(1);
    for (const char* field :
         {"commit", "compiler", "compiler_flags", "cpu_model", "affinity", "binary_sha256"}) {
        const auto& value = provenance[field];
        benchmark::AddCustomContext(std::string("carom_") + field,
                                    value.is_string() ? value.get<std::string>() : "none");
    }
}

void register_case(BenchCase& one, const BenchOptions& options) {
    auto* registered =
        benchmark::RegisterBenchmark(one.name().c_str(), [&one](benchmark::State& state) { one.run(state); });
    registered->UseManualTime()->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);
    if (options.repetitions > 0) {
        registered->Iterations(1)->Repetitions(options.repetitions);
    }
}

/// The record without the error measures, if these are not asked for or the check failed; else with them,
/// from one more run, which must end in the same state as the timed ones.
nlohmann::ordered_json record_with_errors(BenchCase& one, bool errors) {
    const Measurement& measurement = one.measurement();
    auto record = record_json(measurement);
    if (errors && !measurement.violation) {
        const ErrorMeasures measures =
            measure_errors(measurement.scene, measurement.variant, measurement.tuning);
        if (measures.discs != measurement.repetitions.back().discs) {
            one.fail("the run that measures errors ends in another state than the timed ones");
            return record_json(measurement);
        }
        record["errors"] = error_measures_json(measures);
    }
    return record;
}

/// Writes the record asked for, then fails with the first violation, if any.
void finish(std::deque<BenchCase>& cases, const BenchOptions& options) {
    for (BenchCase& one : cases) {
        if (!options.measurement.record.empty() && !one.measurement().repetitions.empty()) {
            write_record(options.measurement.record, record_with_errors(one, options.errors));
        }
    }
    for (const BenchCase& one : cases) {
        if (one.measurement().violation) {
            throw CheckError(one.name() + ": " + *one.measurement().violation);
        }
    }
}

void bench(BenchOptions options, const std::vector<std::string>& flags) {
    if (options.threads.empty()) {
        options.threads.push_back(default_threads());
    }
    std::ranges::for_each(options.threads, require_threads);
    if (!options.measurement.record.empty()) {
        require_one_case(options);
        options.repetitions = std::max(options.repetitions, 1);
    }
    tags_json(options.measurement.tags);
    initialize(flags);
    std::deque<LoadedScene> scenes;
    std::deque<BenchCase> cases;
    for (const std::string& path : options.scenes) {
        const LoadedScene& loaded = scenes.emplace_back(load_scene(path));
        for (const std::string& name : options.variants) {
            for (const int threads : options.threads) {
                Tuning tuning = options.tuning;
                tuning.threads = threads;
                cases.emplace_back(
                    measurement_of(loaded, require_variant(name, loaded.scene), tuning, options.measurement));
                register_case(cases.back(), options);
            }
        }
    }
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    finish(cases, options);
}

} // namespace

void add_bench_command(CLI::App& program) {
    auto options = std::make_shared<BenchOptions>();
    CLI::App* command = program.add_subcommand(
        "bench", "Time variants under Google Benchmark; --benchmark_* flags are handed through to it");
    command->allow_extras();
    command->add_option("SCENE", options->scenes, "Scene files")->required();
    command->add_option("--variant", options->variants, "Names from `carom list`; may be repeated")
        ->take_all()
        ->capture_default_str();
    command->add_option("--threads", options->threads, "OpenMP thread counts; may be repeated")
        ->take_all()
        ->check(CLI::Range(1, most_threads));
    command
        ->add_option("--repetitions", options->repetitions,
                     "Runs to time, each reported (default: as many as Google Benchmark's own flags ask for; "
                     "1 with --record)")
        ->check(CLI::Range(1, 1'000'000));
    add_measurement_options(*command, options->measurement);
    command
        ->add_flag(
            "--errors", options->errors,
            "Keep every error measure in the record, from one more run beside the event-driven reference")
        ->needs(command->get_option("--record"));
    add_tuning_options(*command, options->tuning);
    command->callback([command, options] { bench(*options, command->remaining()); });
}

} // namespace carom

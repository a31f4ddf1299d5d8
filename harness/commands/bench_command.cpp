#include <algorithm>
#include <deque>
#include <iostream>
#include <map>
#include <memory>
#include <sstream>
#include <streambuf>
#include <string>
#include <string_view>
#include <vector>

#include <benchmark/benchmark.h>

#include "harness/accuracy/error_measures.hpp"
#include "harness/command_line/usage_errors.hpp"
#include "harness/command_line/values.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/measurement_options.hpp"
#include "harness/commands/simulation_options.hpp"
#include "harness/machine/disturbance.hpp"
#include "harness/machine/provenance.hpp"
#include "harness/machine/threads.hpp"
#include "harness/measure/bench_case.hpp"
#include "harness/records/record.hpp"
#include "harness/support/errors.hpp"
#include "harness/support/note.hpp"
#include "harness/support/text.hpp"

namespace carom {
namespace {

/// While it lives, what is written to std::cerr is kept.
class KeptErrors {
  public:
    KeptErrors() : outside_(std::cerr.rdbuf(kept_.rdbuf())) {}
    ~KeptErrors() { std::cerr.rdbuf(outside_); }
    KeptErrors(const KeptErrors&) = delete;
    KeptErrors& operator=(const KeptErrors&) = delete;

    std::vector<std::string> lines() const { return CLI::detail::split(kept_.str(), '\n'); }

  private:
    std::ostringstream kept_;
    std::streambuf* outside_;
};

void require_words(const std::string& flag) {
    const std::vector<std::string> formats{"console", "json", "csv"};
    // The flags whose other values make Google Benchmark print how it is used.
    const std::map<std::string, std::vector<std::string>> flags_of_words{
        {"--benchmark_format", formats},
        {"--benchmark_out_format", formats},
        {"--benchmark_time_unit", {"ns", "us", "ms", "s"}}};
    const auto equals = std::min(flag.find('='), flag.size());
    const auto found = flags_of_words.find(flag.substr(0, equals));
    if (found != flags_of_words.end()) {
        std::string value = flag.substr(std::min(equals + 1, flag.size()));
        if (const std::string why = one_of(found->second)(value); !why.empty()) {
            throw InputError(found->first + ": " + why);
        }
    }
    if (flag == "--benchmark_color=" || flag == "--benchmark_help") {
        throw InputError("found '" + flag +
                         "', expected another flag of Google Benchmark, as `carom bench --help` "
                         "hands them on");
    }
}

/// Hands the --benchmark_* flags to Google Benchmark. Throws InputError for a flag, or a value of one, that
/// it does not take: by itself it prints how it is used and ends the process, as if all were well.
void initialize_google_benchmark(const std::vector<std::string>& flags) {
    static std::string program = "carom"; // Google Benchmark keeps the pointer and prints it much later
    std::vector<std::string> texts = flags;
    std::vector<char*> pointers{program.data()};
    for (std::string& text : texts) {
        require_words(text);
        pointers.push_back(text.data());
    }
    int count = static_cast<int>(pointers.size());
    const KeptErrors errors;
    benchmark::Initialize(&count, pointers.data());
    if (count > 1) {
        const std::string said = CLI::detail::join(errors.lines(), " ");
        throw InputError("found " + in_quotes(pointers[1]) + ", expected a flag that Google Benchmark knows" +
                         (said.empty() ? "" : "; it says: " + said));
    }
}

/// Passes on what Google Benchmark has said on standard error. That it was built as DEBUG is explained, and
/// that no case was let through is told by who asked.
void pass_on(const std::vector<std::string>& lines) {
    for (const std::string& line : lines) {
        const auto has = [&line](std::string_view part) { return line.find(part) != std::string::npos; };
        if (has("Library was built as DEBUG")) {
            note("Google Benchmark was built as DEBUG, as Debian's package is: it only asks for runs here, "
                 "and the times are those of carom's own clock");
        } else if (!line.empty() && !has("match any benchmarks") && !has("compile benchmark re")) {
            std::cerr << line << '\n';
        }
    }
}

/// Runs all registered cases that the filter lets through. Throws InputError if no case is let
/// through; `flags` are those of the initialization, and `example` is the name of a case.
void run_google_benchmark(const std::vector<std::string>& flags, const std::string& example) {
    std::vector<std::string> said;
    const auto cases = [&said] {
        const KeptErrors errors;
        const auto count = benchmark::RunSpecifiedBenchmarks();
        benchmark::Shutdown();
        said = errors.lines();
        return count;
    }();
    pass_on(said);
    if (cases > 0) {
        return;
    }
    static constexpr std::string_view name = "--benchmark_filter=";
    const auto filter = std::ranges::find_if(flags, [](const auto& flag) { return flag.starts_with(name); });
    throw InputError("--benchmark_filter: found " +
                     (filter == flags.end() ? "none that fits" : in_quotes(filter->substr(name.size()))) +
                     ", expected a regular expression that is found in a case's name, such as '" + example +
                     "'");
}

struct BenchOptions {
    std::vector<std::string> scenes;
    std::vector<std::string> variants{"published"};
    std::string library;
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

/// What the verb does not know itself must be flags of Google Benchmark.
void require_benchmark_flags(const CLI::App& command, const std::vector<std::string>& flags) {
    if (const auto unknown = unknown_option(command, flags)) {
        throw InputError(*unknown);
    }
    for (const std::string& flag : flags) {
        if (flag.starts_with("--benchmark_perf_counters")) {
            throw InputError(
                flag + ": Google Benchmark as packaged is built without libpfm and would count nothing; "
                       "`carom profile --counters` counts through PAPI");
        }
        if (!flag.starts_with("--benchmark_")) {
            throw InputError("found " + in_quotes(flag) +
                             ", expected an option of `carom bench --help` or a --benchmark_* flag");
        }
    }
}

void add_context() {
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

/// The case without the error measures, if these are not asked for or the check failed; else with them,
/// from one more run, which must end in the same state as the timed ones.
nlohmann::ordered_json with_errors(BenchCase& one, bool errors) {
    const Measurement& measurement = one.measurement();
    auto json = contender_json(measurement);
    if (errors && !measurement.violation) {
        const ErrorMeasures measures =
            measure_errors(measurement.scene, measurement.variant, measurement.tuning);
        if (measures.discs != measurement.repetitions.back().discs) {
            one.fail("the run that measures errors ends in another state than the timed ones");
            return contender_json(measurement);
        }
        json["errors"] = error_measures_json(measures);
    }
    return json;
}

/// Writes the record asked for, then fails with the first violation, if any. What stood still has no record,
/// unless its result was wrong, which is true of it all the same.
void finish(std::deque<BenchCase>& cases, const BenchOptions& options) {
    for (BenchCase& one : cases) {
        const bool counts = one.measurement().violation || !one.suspended();
        if (!options.measurement.record.empty() && !one.measurement().repetitions.empty() && counts) {
            write_record(options.measurement.record, "bench",
                         nlohmann::ordered_json::array({with_errors(one, options.errors)}),
                         one.measurement().tuning.threads);
        }
    }
    for (const BenchCase& one : cases) {
        if (one.measurement().violation) {
            throw CheckError(one.name() + ": " + *one.measurement().violation);
        }
    }
    for (const BenchCase& one : cases) {
        if (one.suspended()) {
            throw InputError(one.name() + ": " + *one.suspended());
        }
    }
}

void bench(BenchOptions options, const std::vector<std::string>& flags) {
    const DisturbanceWatch watch;
    if (options.threads.empty()) {
        options.threads.push_back(default_threads());
    }
    std::ranges::for_each(options.threads, require_threads);
    if (!options.measurement.record.empty()) {
        require_one_case(options);
        options.repetitions = std::max(options.repetitions, 1);
    }
    initialize_google_benchmark(flags);
    add_context();
    std::deque<LoadedScene> scenes;
    std::deque<BenchCase> cases;
    for (const std::string& path : options.scenes) {
        const LoadedScene& loaded = scenes.emplace_back(load_scene(path));
        for (const std::string& name : options.variants) {
            for (const int threads : options.threads) {
                Tuning tuning = options.tuning;
                tuning.threads = threads;
                cases.emplace_back(
                    measurement_of(loaded, require_variant(name, loaded.scene, tuning, options.library),
                                   tuning, options.measurement, options.library));
                register_case(cases.back(), options);
            }
        }
    }
    const int most_threads_used = std::ranges::max(options.threads);
    run_google_benchmark(flags, cases.front().name());
    finish(cases, options);
    note_crowding(most_threads_used);
    note_if_busy(watch, most_threads_used);
}

} // namespace

void add_bench_command(CLI::App& program) {
    auto options = std::make_shared<BenchOptions>();
    CLI::App* command = program.add_subcommand(
        "bench", "Time variants under Google Benchmark; --benchmark_* flags are handed through to it");
    command->allow_extras();
    command->add_option("SCENE", options->scenes, "Scene files; - is standard input")->required();
    command->add_option("--variant", options->variants, "Names from `carom list`; may be repeated")
        ->take_all()
        ->default_str(options->variants.front());
    add_library_option(*command, options->library);
    command->add_option("--threads", options->threads, "OpenMP thread counts; may be repeated")
        ->take_all()
        ->transform(number_from(1, most_threads))
        ->type_name("N")
        ->default_str(number_text(default_threads()));
    add_number(*command, "--repetitions", options->repetitions, 1, 1'000'000,
               "Runs to time, each reported (default: as many as Google Benchmark's own flags ask for; "
               "1 with --record)")
        ->default_str("");
    add_measurement_options(*command, options->measurement);
    command
        ->add_flag(
            "--errors", options->errors,
            "Keep every error measure in the record, from one more run beside the event-driven reference")
        ->needs(command->get_option("--record"));
    add_tuning_options(*command, options->tuning);
    command->callback([command, options] {
        require_benchmark_flags(*command, command->remaining());
        bench(*options, command->remaining());
    });
}

} // namespace carom

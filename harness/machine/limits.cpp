#include "harness/machine/limits.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <utility>

#include <benchmark/benchmark.h>

#include "harness/machine/threads.hpp"
#include "harness/support/errors.hpp"
#include "harness/support/format.hpp"
#include "harness/support/process_clock.hpp"
#include "kernels/parallel_for.hpp"

namespace carom {
namespace {

using Json = nlohmann::ordered_json;

#if defined(__AVX512F__)
constexpr int native_lanes = 8;
#elif defined(__AVX__)
constexpr int native_lanes = 4;
#else
constexpr int native_lanes = 2;
#endif
using Vector [[gnu::vector_size(native_lanes * sizeof(double))]] = double;

/// Keeps the compiler from joining several of these into one register, or from doing them ahead of time.
template <class Number> void keep_apart(Number& number) {
#if defined(__x86_64__)
    __asm__("" : "+x"(number));
#elif defined(__aarch64__)
    __asm__("" : "+w"(number));
#else
    benchmark::DoNotOptimize(number);
#endif
}

/// As many as hide the latency of a multiplication and an addition, and fit the 16 registers of SSE2 with the
/// two constants.
constexpr int chain_count = 12;

/// Every chain tends to 1, so that no operand is ever special. Indices that are constants from the start keep
/// every chain in a register.
template <class Number, std::size_t... k> void run_chains(std::int64_t turns, std::index_sequence<k...>) {
    std::array<Number, sizeof...(k)> chains{};
    const Number factor = Number{} + 0.875;
    const Number addend = Number{} + 0.125;
    const auto advance = [factor, addend](Number& chain) {
        chain = chain * factor + addend;
        keep_apart(chain);
    };
    for (std::int64_t turn = 0; turn < turns; ++turn) {
        (advance(chains[k]), ...);
    }
    Number sum = (chains[k] + ...);
    benchmark::DoNotOptimize(sum);
}

/// Seconds in which every thread runs `work(thread, turns)`, from the first to begin to the last to end.
template <class Work> double timed(int threads, std::int64_t turns, const Work& work) {
    const double start = process_seconds();
    on_each_thread(threads, [&work, turns](int thread) { work(thread, turns); });
    return process_seconds() - start;
}

/// So many turns that one thread alone works for two milliseconds each of three times: below that, starting
/// the threads would count.
template <class Work> std::int64_t enough_turns(const Work& work) {
    const auto takes_long = [&work](std::int64_t turns) { return timed(1, turns, work) >= 2e-3; };
    std::int64_t turns = 1;
    while (!takes_long(turns) || !takes_long(turns) || !takes_long(turns)) {
        turns *= 2;
    }
    return turns;
}

/// The rate of `amount` a turn.
template <class Work> Rate measure(int threads, double amount, double seconds, const Work& work) {
    constexpr std::size_t fewest = 5;
    constexpr std::size_t most = 10'000;
    const std::int64_t turns = enough_turns(work);
    std::vector<double> rates;
    for (double spent = 0; rates.size() < fewest || (spent < seconds && rates.size() < most);) {
        const double once = timed(threads, turns, work);
        rates.push_back(amount * static_cast<double>(turns) / once);
        spent += once;
    }
    std::ranges::sort(rates);
    return {.best = rates.back(),
            .median = rates[rates.size() / 2],
            .repetitions = static_cast<int>(rates.size())};
}

using Array = std::unique_ptr<double[], decltype([](double* numbers) { std::free(numbers); })>;

/// Not initialised, at the beginning of a page. The C library's copy is twenty times slower on some
/// processors where the target begins a few bytes later in its page than the source, as from `new` it does.
Array make_array(std::size_t length) {
    constexpr std::size_t page = 4096;
    const std::size_t bytes = (length * sizeof(double) + page - 1) / page * page;
    Array array(static_cast<double*>(std::aligned_alloc(page, bytes)));
    if (array == nullptr) {
        throw std::bad_alloc();
    }
    return array;
}

struct Part {
    Array from;
    Array to;
};

} // namespace

std::vector<WorkingSet> working_sets(const Topology& topology, std::int64_t most_bytes, int threads) {
    constexpr std::int64_t smallest = std::int64_t{32} << 10;
    std::vector<CacheLevel> caches = topology.caches;
    std::erase_if(caches, [](const CacheLevel& cache) { return cache.name == "L1i" || cache.bytes <= 0; });
    // Where nobody tells, more than most machines have.
    const std::int64_t last_level =
        caches.empty() ? std::int64_t{64} << 20 : caches.back().bytes * caches.back().count;
    const auto level_of = [&caches, threads](std::int64_t bytes) -> std::string {
        for (const CacheLevel& cache : caches) {
            const int sharing = std::max(cache.hardware_threads, 1);
            if (bytes <= cache.bytes * std::min((threads + sharing - 1) / sharing, cache.count)) {
                return cache.name;
            }
        }
        return "memory";
    };
    // A copy has two arrays.
    const std::int64_t largest = std::min(2 * (4 * last_level), most_bytes);
    std::vector<WorkingSet> sets;
    for (std::int64_t bytes = smallest; bytes <= largest / 2; bytes *= 4) {
        sets.push_back({level_of(bytes), bytes});
    }
    sets.push_back({level_of(largest), largest});
    return sets;
}

Rate measure_copy(const WorkingSet& set, int threads, double seconds) {
    require_threads(threads);
    const auto count = static_cast<std::size_t>(threads);
    const auto length =
        std::max<std::size_t>(static_cast<std::size_t>(set.bytes) / (2 * sizeof(double) * count), 1);
    std::vector<Part> parts(count);
    for (Part& part : parts) {
        part = {make_array(length), make_array(length)};
    }
    // A page lies near the thread that touches it first.
    on_each_thread(threads, [&parts, length](int thread) {
        Part& part = parts[static_cast<std::size_t>(thread)];
        std::fill_n(part.from.get(), length, 1.0 + thread);
        std::fill_n(part.to.get(), length, 0.0);
    });
    const double bytes = 2.0 * sizeof(double) * static_cast<double>(length * count);
    const Rate rate = measure(threads, bytes, seconds, [&parts, length](int thread, std::int64_t turns) {
        const Part& part = parts[static_cast<std::size_t>(thread)];
        for (std::int64_t turn = 0; turn < turns; ++turn) {
            std::copy_n(part.from.get(), length, part.to.get());
            benchmark::ClobberMemory();
        }
    });
    for (const Part& part : parts) {
        if (!std::equal(part.from.get(), part.from.get() + length, part.to.get())) {
            throw CheckError("copy in " + set.level + ": the two arrays differ");
        }
    }
    return rate;
}

int lanes(Arithmetic arithmetic) { return arithmetic == Arithmetic::scalar ? 1 : native_lanes; }

Rate measure_arithmetic(Arithmetic arithmetic, int threads, double seconds) {
    require_threads(threads);
    constexpr std::int64_t turns_at_once = 1000;
    const double operations = 2.0 * chain_count * turns_at_once * lanes(arithmetic) * threads;
    const auto measure_chains_of = [&]<class Number>(Number /*type*/) {
        return measure(threads, operations, seconds, [](int, std::int64_t turns) {
            run_chains<Number>(turns * turns_at_once, std::make_index_sequence<chain_count>());
        });
    };
    return arithmetic == Arithmetic::scalar ? measure_chains_of(double{}) : measure_chains_of(Vector{});
}

nlohmann::ordered_json measure_limits(int threads, double seconds, std::int64_t most_bytes) {
    require_threads(threads);
    const Topology topology = read_topology();
    const auto rate_json = [](const Rate& rate) {
        return Json{{"best", rate.best}, {"median", rate.median}, {"repetitions", rate.repetitions}};
    };
    Json copy = Json::array();
    Json arithmetic = Json::array();
    for (int count = 1; count <= threads; ++count) {
        for (const WorkingSet& set : working_sets(topology, most_bytes, count)) {
            copy.push_back({{"level", set.level},
                            {"working_set_bytes", set.bytes},
                            {"threads", count},
                            {"bytes_per_second", rate_json(measure_copy(set, count, seconds))}});
        }
        for (const Arithmetic kind : {Arithmetic::scalar, Arithmetic::vector}) {
            const Rate rate = measure_arithmetic(kind, count, seconds);
            arithmetic.push_back(
                {{"lanes", lanes(kind)}, {"threads", count}, {"operations_per_second", rate_json(rate)}});
        }
    }
    return {{"copy", copy}, {"arithmetic", arithmetic}};
}

std::string limits_text(const nlohmann::ordered_json& limits) {
    const auto rate_text = [](int threads, const Json& rate, const char* unit) {
        return format("%3d %-7s %9.4g %s (median %.4g of %d)\n", threads, threads == 1 ? "thread" : "threads",
                      1e-9 * rate["best"].get<double>(), unit, 1e-9 * rate["median"].get<double>(),
                      rate["repetitions"].get<int>());
    };
    std::string text = "best rates\n";
    for (const Json& one : limits["copy"]) {
        text += format("copy within %7lld KiB, %-6s ", one["working_set_bytes"].get<long long>() / 1024,
                       one["level"].get<std::string>().c_str()) +
                rate_text(one["threads"], one["bytes_per_second"], "GB/s");
    }
    for (const Json& one : limits["arithmetic"]) {
        text += format("x * a + b, %d at once           ", one["lanes"].get<int>()) +
                rate_text(one["threads"], one["operations_per_second"], "Gflop/s");
    }
    return text;
}

} // namespace carom

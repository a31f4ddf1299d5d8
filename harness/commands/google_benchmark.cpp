#include "harness/commands/google_benchmark.hpp"

#include <algorithm>
#include <iostream>
#include <map>
#include <streambuf>
#include <string_view>

#include <benchmark/benchmark.h>

#include "harness/command_line/values.hpp"
#include "harness/support/errors.hpp"
#include "harness/support/note.hpp"
#include "harness/support/text.hpp"

namespace carom {
namespace {

/// While it lives, std::cerr is read line by line; what is neither explained nor kept is passed on.
class Messages : public std::streambuf {
  public:
    explicit Messages(bool keep_all) : keep_all_(keep_all), outside_(std::cerr.rdbuf(this)) {}
    ~Messages() override {
        std::cerr.rdbuf(outside_);
        if (!line_.empty()) {
            std::cerr << line_;
        }
    }
    Messages(const Messages&) = delete;
    Messages& operator=(const Messages&) = delete;

    /// The lines that were kept, as one.
    const std::string& kept() const { return kept_; }

  protected:
    int overflow(int letter) override {
        if (letter == '\n') {
            take_line();
        } else if (letter != traits_type::eof()) {
            line_ += static_cast<char>(letter);
        }
        return traits_type::not_eof(letter);
    }

  private:
    bool has(std::string_view part) const { return line_.find(part) != std::string::npos; }

    void take_line() {
        if (keep_all_ || has("match any benchmarks") || has("compile benchmark re")) {
            kept_ += (kept_.empty() ? "" : " ") + line_;
        } else if (has("Library was built as DEBUG")) {
            note("Google Benchmark was built as DEBUG, as Debian's package is: it only asks for runs here, "
                 "and "
                 "the times are those of carom's own clock");
        } else {
            const std::string line = line_ + '\n';
            outside_->sputn(line.data(), static_cast<std::streamsize>(line.size()));
        }
        line_.clear();
    }

    bool keep_all_;
    std::streambuf* outside_;
    std::string line_;
    std::string kept_;
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

} // namespace

void initialize_google_benchmark(const std::vector<std::string>& flags) {
    static std::string program = "carom"; // Google Benchmark keeps the pointer and prints it much later
    std::vector<std::string> texts = flags;
    std::vector<char*> pointers{program.data()};
    for (std::string& text : texts) {
        require_words(text);
        pointers.push_back(text.data());
    }
    int count = static_cast<int>(pointers.size());
    const Messages messages(true);
    benchmark::Initialize(&count, pointers.data());
    if (count > 1) {
        throw InputError("found " + in_quotes(pointers[1]) + ", expected a flag that Google Benchmark knows" +
                         (messages.kept().empty() ? "" : "; it says: " + messages.kept()));
    }
}

void run_google_benchmark(const std::vector<std::string>& flags, const std::string& example) {
    const Messages messages(false);
    const auto cases = benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
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

} // namespace carom

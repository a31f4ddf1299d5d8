#include "harness/measure/timeline.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include <nlohmann/json.hpp>

#include "harness/support/format.hpp"
#include "harness/support/output_file.hpp"

namespace carom {
namespace {

std::string event_text(const Span& span, int thread) {
    // Of the kinds, in their order; behind a blank what stands behind the phase.
    constexpr std::array<std::string_view, 5> kinds{" ", "sweep", " loop", "wait", " chunk"};
    const std::string kind(kinds[static_cast<std::size_t>(span.kind)]);
    const std::string name =
        kind.front() != ' ' ? kind : std::string(word(span.phase)) + (kind == " " ? "" : kind);
    const std::string chunk =
        span.kind == Span::Kind::chunk
            ? format(R"(,"args":{"first":%lld,"count":%lld})", static_cast<long long>(span.first),
                     static_cast<long long>(span.count))
            : "";
    return format(R"({"name":"%s","ph":"X","pid":1,"tid":%d,"ts":%.3f,"dur":%.3f%s})", name.c_str(), thread,
                  1e6 * span.begin, 1e6 * (span.end - span.begin), chunk.c_str());
}

/// Outer spans before inner ones that begin with them.
bool begins_before(const Span& one, const Span& other) {
    return one.begin != other.begin ? one.begin < other.begin : one.end > other.end;
}

} // namespace

std::string_view word(Phase phase) {
    constexpr std::array<std::string_view, phase_count> words{"move", "bin", "find", "resolve"};
    return words[static_cast<std::size_t>(phase)];
}

void write_timeline(const std::string& path, const Profiler& profiler, const std::string& title) {
    OutputFile file(path);
    const nlohmann::ordered_json about{{"title", title}, {"spans_left_out", profiler.spans_left_out()}};
    file.write("{\"displayTimeUnit\":\"ms\",\"otherData\":" + about.dump() + ",\"traceEvents\":[\n");
    for (int thread = 0; thread < profiler.threads(); ++thread) {
        std::string text = R"({"name":"thread_name","ph":"M","pid":1,"tid":)" + std::to_string(thread) +
                           R"(,"args":{"name":"thread )" + std::to_string(thread) + "\"}}";
        std::vector<Span> spans = profiler.spans(thread);
        std::stable_sort(spans.begin(), spans.end(), begins_before);
        for (const Span& span : spans) {
            text += ",\n" + event_text(span, thread);
        }
        file.write(text + (thread + 1 < profiler.threads() ? ",\n" : "\n"));
    }
    file.write("]}\n");
    file.finish();
}

} // namespace carom

#include "harness/support/benchmark_json.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <regex>
#include <set>
#include <string_view>

#include "harness/support/errors.hpp"
#include "harness/support/format.hpp"
#include "harness/support/text.hpp"

namespace carom {
namespace {

using Json = nlohmann::json;

constexpr std::array<std::string_view, 3> words_of_numbers{"-Infinity", "Infinity", "NaN"};

/// The same, where bytes that are no UTF-8 stand as U+FFFD.
std::string as_utf8(const std::string& text) {
    const std::string quoted = Json(text).dump(-1, ' ', false, Json::error_handler_t::replace);
    return Json::parse(quoted).get<std::string>();
}

/// The word of a number that begins `rest`, or nothing.
std::string_view word_at(std::string_view rest) {
    const auto word = std::ranges::find_if(words_of_numbers, [rest](std::string_view one) {
        const std::string_view after = rest.substr(std::min(one.size(), rest.size()), 1);
        return rest.starts_with(one) &&
               (after.empty() || std::isalpha(static_cast<unsigned char>(after.front())) == 0);
    });
    return word == words_of_numbers.end() ? std::string_view() : *word;
}

/// The same as JSON: a number that is none becomes a list of its word, which the library itself never writes.
std::string as_json(std::string_view text) {
    std::string json;
    json.reserve(text.size());
    bool in_string = false;
    bool is_escaped = false;
    for (std::size_t k = 0; k < text.size();) {
        const char letter = text[k];
        const std::string_view word = in_string ? std::string_view() : word_at(text.substr(k));
        if (!word.empty()) {
            json.append("[\"").append(word).append("\"]");
            k += word.size();
            continue;
        }
        if (in_string && letter >= '\0' && letter < ' ') {
            json += format("\\u%04x", static_cast<unsigned int>(letter));
        } else {
            json += letter;
        }
        in_string = in_string != (letter == '"' && !is_escaped);
        is_escaped = in_string && letter == '\\' && !is_escaped;
        ++k;
    }
    return json;
}

[[noreturn]] void refuse_report(const std::string& found) {
    throw InputError("benchmark: found " + found + ", expected what --benchmark_out_format=json writes");
}

/// The rest of the line from there on, or its beginning.
std::string line_from(std::string_view text) {
    return in_quotes(text.substr(0, std::min(text.find_first_of("\r\n"), text.size())));
}

/// Whether the parser stopped at a number as locales write it: with a comma, or with something between
/// groups of digits, U+2019, U+00A0 and U+202F among them (U+FFFD is what other bytes have become).
bool is_of_a_locale(std::string_view before, std::string_view after) {
    static const std::regex of_a_locale(
        ": *-?[0-9.]+(?:[,']|\xE2\x80\x99|\xC2\xA0|\xE2\x80\xAF|\xEF\xBF\xBD|\\.[0-9]+\\.)[0-9]");
    constexpr std::size_t around = 40;
    const std::string text(before.substr(before.size() - std::min(before.size(), around)));
    return std::regex_search(text + std::string(after.substr(0, around)), of_a_locale);
}

/// What stands where the parser stopped, of which it names the number of bytes up to there.
std::string found_at(const std::string& json, std::size_t bytes) {
    constexpr std::size_t shown = 40;
    const std::size_t begin = json.find_first_not_of(" \t\r\n");
    if (begin == std::string::npos) {
        return json.empty() ? "an empty file" : "nothing but blanks";
    }
    const std::string_view text = json;
    if (text[begin] != '{') {
        return "no JSON of Google Benchmark but " + line_from(text.substr(begin));
    }
    const std::size_t end = text.find_last_not_of(" \t\r\n") + 1;
    if (bytes > end) {
        return "JSON that breaks off after " + in_quotes(text.substr(end - std::min(end, shown)), shown);
    }
    const std::string_view before = text.substr(0, std::max<std::size_t>(bytes, 1) - 1);
    const std::string_view after = text.substr(before.size());
    return "no JSON in line " + number_text(1 + std::ranges::count(before, '\n')) + ": " + line_from(after) +
           (is_of_a_locale(before, after)
                ? " (numbers in the form of a locale; with LC_ALL=C in its environment they are plain)"
                : "");
}

/// Parses it, the first of several fields of one name being the one that counts.
Json parse_report(const std::string& json) {
    std::map<int, std::set<std::string>> names; // of the objects that are open, by their depth
    const auto take = [&names](int depth, Json::parse_event_t event, Json& parsed) {
        if (event == Json::parse_event_t::object_start) {
            names[depth + 1].clear();
        }
        return event != Json::parse_event_t::key || names[depth].insert(parsed.get<std::string>()).second;
    };
    try {
        return Json::parse(json, take);
    } catch (const Json::parse_error& error) {
        refuse_report(found_at(json, error.byte));
    } catch (const Json::out_of_range&) {
        refuse_report("a number that is too large");
    }
}

} // namespace

Json read_benchmark_json(const std::string& text) {
    Json document = parse_report(as_json(as_utf8(text)));
    if (!document.is_object() || !document.contains("benchmarks") || !document["benchmarks"].is_array()) {
        refuse_report("JSON without a list `benchmarks`");
    }
    if (!std::ranges::all_of(document["benchmarks"], [](const Json& run) { return run.is_object(); })) {
        refuse_report("something in the list `benchmarks` that is no object");
    }
    return document;
}

std::string not_finite(const Json& value) {
    return value.is_array() && value.size() == 1 && value.front().is_string()
               ? value.front().get<std::string>()
               : "";
}

} // namespace carom

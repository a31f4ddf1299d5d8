#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>

namespace carom {

/// The number in a file behind a text, and behind another one that follows it; empty where there is none.
template <class Number>
std::optional<Number> number_in(const std::filesystem::path& path, std::string_view text = "",
                                std::string_view then = "") {
    std::ifstream file(path);
    const std::string all(std::istreambuf_iterator<char>(file), {});
    const std::size_t begin = all.find(then, all.find(text));
    std::istringstream rest(
        begin == std::string::npos ? "" : all.substr(begin + (then.empty() ? text : then).size()));
    Number number{};
    return rest >> number ? std::optional(number) : std::nullopt;
}

} // namespace carom

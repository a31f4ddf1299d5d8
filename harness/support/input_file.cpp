#include "harness/support/input_file.hpp"

#include <array>
#include <cstddef>
#include <fstream>

#include "harness/support/errors.hpp"

namespace carom {

std::string read_file(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file || std::filesystem::is_directory(path)) {
        throw InputError(path.string() + ": cannot be read, expected a readable file");
    }
    std::string text;
    std::array<char, 1 << 16> buffer;
    while (file.read(buffer.data(), buffer.size()) || file.gcount() > 0) {
        text.append(buffer.data(), static_cast<std::size_t>(file.gcount()));
    }
    if (file.bad()) {
        throw InputError(path.string() + ": reading broke off, expected a readable file");
    }
    return text;
}

} // namespace carom

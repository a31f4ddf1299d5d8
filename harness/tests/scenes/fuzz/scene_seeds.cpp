#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "harness/scenes/scene_file.hpp"
#include "harness/tests/scenes/random_scenes.hpp"

namespace {

/// What is no number of a scene, or the last one that is: libFuzzer seldom puts one where a number stands.
constexpr const char* awkward_words[] = {"nan",    "-inf", "1e60", "1.1e60", "1e999",
                                         "1e-999", "0x1",  "-",    "+1"};

void write(const std::filesystem::path& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
}

} // namespace

/// Writes a seed corpus for the fuzzer of the scene reader into a folder: awkward
/// scenes, and the same with one number replaced.
int main(int count, char** arguments) try {
    if (count != 2) {
        std::fprintf(stderr, "expected one argument, the folder to write into\n");
        return 1;
    }
    const std::filesystem::path folder = arguments[1];
    std::filesystem::create_directories(folder);
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        carom::Scene scene = carom::tests::awkward_scene(seed);
        scene.discs.resize(std::min<std::size_t>(scene.discs.size(), seed % 8));
        const std::string text = carom::scene_text(scene);
        const std::string name = "seed" + std::to_string(seed);
        write(folder / name, text);
        write(folder / (name + "-word"), text.substr(0, text.find_last_of(" \n", text.size() - 2) + 1) +
                                             awkward_words[seed % std::size(awkward_words)] + "\n");
    }
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}

#include "harness/machine/other_build.hpp"

#include <dlfcn.h>

#include "harness/machine/build.hpp"
#include "harness/machine/provenance.hpp"
#include "harness/support/errors.hpp"
#include "harness/support/input_file.hpp"
#include "harness/support/sha256.hpp"

namespace carom {
namespace {

const ExportedBuild& load(const std::string& library) {
    // A name without a slash would be looked for among the libraries of the system.
    const std::string path = library.find('/') == std::string::npos ? "./" + library : library;
    void* const handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (handle == nullptr) {
        throw InputError("--variants-of: " + std::string(dlerror()) +
                         ", expected carom-variants.so of a build");
    }
    // Its threads would be others than those of this program: two pools on the same processors.
    if (dlsym(handle, "__kmpc_fork_call") != nullptr && openmp_json()["runtime"] != "libomp") {
        throw InputError("--variants-of: " + library +
                         ": found code for the OpenMP runtime of clang++, expected "
                         "that of this program; carom-libomp, beside g++'s carom, has it");
    }
    const auto* const found = static_cast<const ExportedBuild*>(dlsym(handle, other_build_symbol));
    if (found == nullptr) {
        throw InputError("--variants-of: " + library +
                         ": found no variants, expected carom-variants.so of a build");
    }
    if (source_of(found->build) != source_of(this_build())) {
        throw InputError("--variants-of: " + library + ": found the code of " + source_of(found->build) +
                         ", expected that of this program, " + source_of(this_build()) + "; build both anew");
    }
    return *found;
}

} // namespace

const Variant& variant_of_build(const std::string& library, std::string_view name) {
    const Variant* const variant = load(library).find_variant(name);
    if (variant == nullptr) {
        throw InputError("--variants-of: " + library + ": found no variant " + std::string(name));
    }
    return *variant;
}

nlohmann::ordered_json provenance_of_build(const std::string& library) {
    nlohmann::ordered_json json = build_json(load(library).build);
    json["binary_sha256"] = sha256(own_sha256() + sha256(read_file(library)));
    return json;
}

} // namespace carom

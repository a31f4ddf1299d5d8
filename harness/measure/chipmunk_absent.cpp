#include "harness/measure/chipmunk.hpp"
#include "harness/support/errors.hpp"

// Stands in for chipmunk.cpp where the program is built without the library, which is what happens by itself.

namespace carom {

ChipmunkRun run_chipmunk(const Scene& /*scene*/, int /*substeps*/, int /*iterations*/) {
    throw NotBuiltIn(
        "built without Chipmunk; install libchipmunk-dev and configure with -DCAROM_CHIPMUNK=ON");
}

} // namespace carom

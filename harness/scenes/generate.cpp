#include "harness/scenes/generate.hpp"

#include <cmath>
#include <cstddef>

namespace carom {
namespace {

/// A direction uniform over the circle, as a unit vector. Points close to the middle are drawn anew: their
/// directions are coarse.
Point direction(RandomNumbers& random) {
    while (true) {
        const Point point = random.in_unit_circle();
        const double length = std::sqrt(point.x * point.x + point.y * point.y);
        if (length > 0x1p-10) {
            return {point.x / length, point.y / length};
        }
    }
}

void set_velocity(Disc& disc, const GeneratorArguments& arguments, RandomNumbers& random) {
    const double least = arguments.least_velocity;
    const double largest = arguments.largest_velocity;
    if (arguments.isotropic) {
        const double speed = random.uniform(least, largest);
        const Point towards = direction(random);
        disc.vx = speed * towards.x;
        disc.vy = speed * towards.y;
    } else {
        disc.vx = random.uniform(least, largest);
        disc.vy = random.uniform(least, largest);
    }
}

std::vector<Point> separate_centres(const GeneratorArguments& arguments, RandomNumbers& random) {
    return arguments.placement == Placement::random
               ? random_sequential_centres(arguments.count, arguments.side, arguments.radius, random)
               : lattice_centres(arguments.count, arguments.side, arguments.radius, random);
}

} // namespace

Scene generate(const GeneratorArguments& arguments) {
    RandomNumbers random(arguments.seed);
    Scene scene{.side = arguments.side, .radius = arguments.radius, .steps = arguments.steps, .discs = {}};
    scene.discs.resize(static_cast<std::size_t>(arguments.count));
    if (arguments.placement == Placement::overlapping) {
        for (Disc& disc : scene.discs) {
            disc.x = random.uniform(0, arguments.side);
            disc.y = random.uniform(0, arguments.side);
            set_velocity(disc, arguments, random);
        }
        return scene;
    }
    const std::vector<Point> centres = separate_centres(arguments, random);
    for (std::size_t i = 0; i < centres.size(); ++i) {
        scene.discs[i].x = centres[i].x;
        scene.discs[i].y = centres[i].y;
        set_velocity(scene.discs[i], arguments, random);
    }
    return scene;
}

} // namespace carom

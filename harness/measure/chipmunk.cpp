#include "harness/measure/chipmunk.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>

#include <chipmunk/chipmunk.h>

#include "harness/support/stopwatch.hpp"

namespace carom {
namespace {

template <auto free> struct FreedBy {
    template <class Thing> void operator()(Thing* thing) const { free(thing); }
};
using Space = std::unique_ptr<cpSpace, FreedBy<cpSpaceFree>>;
using Body = std::unique_ptr<cpBody, FreedBy<cpBodyFree>>;
using Shape = std::unique_ptr<cpShape, FreedBy<cpShapeFree>>;

/// The scene as Chipmunk keeps it. Shapes are freed before bodies, and both before the space.
class World {
  public:
    World(const Scene& scene, int iterations) : space_(cpSpaceNew()) {
        cpSpaceSetIterations(space_.get(), iterations);
        add_walls(scene);
        for (const Disc& disc : scene.discs) {
            add_disc(disc, scene.radius);
        }
    }

    ~World() {
        for (const Shape& shape : shapes_) {
            cpSpaceRemoveShape(space_.get(), shape.get());
        }
        for (const Body& body : bodies_) {
            cpSpaceRemoveBody(space_.get(), body.get());
        }
    }
    World(const World&) = delete;
    World& operator=(const World&) = delete;

    void step(double dt) { cpSpaceStep(space_.get(), dt); }

    std::vector<Disc> discs() const {
        std::vector<Disc> result;
        for (const Body& body : bodies_) {
            const cpVect position = cpBodyGetPosition(body.get());
            const cpVect velocity = cpBodyGetVelocity(body.get());
            result.push_back({position.x, position.y, velocity.x, velocity.y});
        }
        return result;
    }

  private:
    /// Walls as thick as a disc is wide, their faces on the sides of the box.
    void add_walls(const Scene& scene) {
        const double thick = 2 * scene.radius;
        const double low = -thick;
        const double high = scene.side + thick;
        const std::array corners{cpv(low, low), cpv(high, low), cpv(high, high), cpv(low, high)};
        for (std::size_t k = 0; k < corners.size(); ++k) {
            add(cpSegmentShapeNew(cpSpaceGetStaticBody(space_.get()), corners[k],
                                  corners[(k + 1) % corners.size()], thick));
        }
    }

    void add_disc(const Disc& disc, double radius) {
        bodies_.emplace_back(cpBodyNew(1, std::numeric_limits<double>::infinity()));
        cpBody* const body = bodies_.back().get();
        cpBodySetPosition(body, cpv(disc.x, disc.y));
        cpBodySetVelocity(body, cpv(disc.vx, disc.vy));
        cpSpaceAddBody(space_.get(), body);
        add(cpCircleShapeNew(body, radius, cpvzero));
    }

    void add(cpShape* shape) {
        shapes_.emplace_back(shape);
        cpShapeSetElasticity(shape, 1);
        cpShapeSetFriction(shape, 0);
        cpSpaceAddShape(space_.get(), shape);
    }

    Space space_;
    std::vector<Body> bodies_;
    std::vector<Shape> shapes_;
};

} // namespace

ChipmunkRun run_chipmunk(const Scene& scene, int substeps, int iterations) {
    World world(scene, iterations);
    Stopwatch stopwatch;
    stopwatch.start();
    for (std::int64_t step = 0; step < std::int64_t{scene.steps} * substeps; ++step) {
        world.step(1.0 / substeps);
    }
    stopwatch.stop();
    return {.steps_seconds = stopwatch.wall_seconds(),
            .cpu_seconds = stopwatch.cpu_seconds(),
            .discs = world.discs(),
            .version = cpVersionString};
}

} // namespace carom

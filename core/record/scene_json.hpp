// Scene and members of a run as JSON: what records hold and views show of all that engines do not move.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/scenario/scenario.hpp"
#include "core/space/sketch.hpp"
#include "core/space/space.hpp"
#include "core/space/stores.hpp"
#include "hal/json/json.hpp"
#include "hal/robot_kind.hpp"

namespace tandem::core {

/// {"arena": {min_x, min_y, max_x, max_y}, "objects": […], "lights": […], "borders": [[x0, y0, x1, y1, wall], …]}, in
/// metres and radians. Movable objects stand where they are at the moment.
hal::Json scene_json(const SpaceStores& stores);

/// The inverse, into stores without any: what makes no sense is left out, or stands for what is usual.
void read_scene(const hal::Json& scene, SpaceStores& stores);

/// Two are equal when the scenes are, but for where movable objects stand.
struct SceneVersion {
  std::uint64_t immovables = 0, leds = 0, movables = 0, lights = 0;
  bool operator==(const SceneVersion&) const = default;
};
/// Allocates nothing; to be asked for in every tick.
SceneVersion scene_version(const SpaceStores& stores) noexcept;

/// What there is to draw of a kind: {"radius", "height", "rotor_arm", "look"}, as docs/view-protocol.md has it.
hal::Json body_json(const hal::RobotKind& kind);
/// The inverse: a kind of which no more is known. Understands what records had before "look".
hal::RobotKind kind_of_body(std::string name, const hal::Json& body);
/// Whether the two are drawn in the same way.
bool looks_alike(const hal::RobotKind& a, const hal::RobotKind& b);

/// Rows of the living robots' bodies, in the order in which they lie in memory.
std::vector<std::uint32_t> living_rows(const SpaceStores& stores);

/// Whether the robot in row `a` of bodies stands before the one in `b` in the file, or came earlier.
bool came_earlier(const SpaceStores& stores, std::uint32_t a, std::uint32_t b) noexcept;

/// {"ids": […], "kinds": […], "kind": [index into kinds, …], "real": [index into ids, …], "bodies": [of each kind],
/// "order": [index into ids, …]} of the robots in these rows of bodies; "order" is that in which the file lists them
/// and hooks added them, and missing where that is how they stand.
/// `bodies`: those that were made before, of kinds that are still there.
using KindBodies = std::map<const hal::RobotKind*, hal::Json>;
hal::Json members_json(const Space& space, std::span<const std::uint32_t> rows, KindBodies& bodies);

/// What hooks drew: {"shapes": [{"kind": "line" | "polygon" | "circle" | "text", "points": [[x, y, z], …], "radius",
/// "text", "color": [r, g, b], "width", "filled", "opacity"}, …]}.
hal::Json sketch_json(const Sketch& sketch);
/// The shapes that it holds; what makes no sense is left out.
Sketch sketch_of_json(const hal::Json& json);
/// Differs when the drawing does.
std::uint64_t sketch_mark(const Sketch& sketch) noexcept;

/// Areas as records and the view protocol have them: [{`kind` ("fence", "keep_out", "zone"), `id`, `corners` [[x, y]],
/// `from`, `to`, `max_speed`}].
hal::Json areas_json(const SafetyConfig& safety);
/// The inverse: what is no area is left out.
SafetyConfig areas_of_json(const hal::Json& areas);

}  // namespace tandem::core

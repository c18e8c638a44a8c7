#include "compat/argos3/simulator/world_adapter.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>

#include "compat/argos3/facade/configuration.hpp"
#include "core/scenario/scenario.hpp"
#include "core/space/attitude.hpp"
#include "core/space/stores.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/wheels.hpp"

namespace tandem::compat::argos3 {
namespace {

core::RobotId robot_id(const Body& body) noexcept {
  return body.Kind == Body::ROBOT ? core::RobotId{body.Index, body.Generation} : core::RobotId();
}
core::ObjectId object_id(const Body& body) noexcept {
  return body.Kind == Body::OBJECT ? core::ObjectId{body.Index, body.Generation} : core::ObjectId();
}
Body body_of(core::RobotId id) noexcept {
  Body body;
  if (!id.valid()) return body;
  body.Kind = Body::ROBOT;
  body.Index = id.index;
  body.Generation = id.generation;
  return body;
}
Body body_of(core::ObjectId id) noexcept {
  Body body;
  if (!id.valid()) return body;
  body.Kind = Body::OBJECT;
  body.Index = id.index;
  body.Generation = id.generation;
  return body;
}

/// A turn about z by the angle of this cosine and sine.
Place place_at(double x_m, double y_m, double z_m, double c, double s) noexcept {
  const double half_rad = 0.5 * std::atan2(s, c);
  return {x_m, y_m, z_m, std::cos(half_rad), 0.0, 0.0, std::sin(half_rad)};
}

core::Pose pose_of(const Place& p) noexcept {
  core::Pose pose{p.x_m, p.y_m, p.z_m, 1.0, 0.0};
  const double ahead_x = 1.0 - 2.0 * (p.y * p.y + p.z * p.z), ahead_y = 2.0 * (p.x * p.y + p.w * p.z);
  const double level = std::hypot(ahead_x, ahead_y);
  if (level > 1e-9) {
    pose.cos_h = ahead_x / level;
    pose.sin_h = ahead_y / level;
  }
  return pose;
}

void put_at(core::Object& object, const Place& place) noexcept {
  const core::Pose pose = pose_of(place);
  object.x_m = pose.x_m;
  object.y_m = pose.y_m;
  object.z_high_m += pose.z_m - object.z_low_m;
  object.z_low_m = pose.z_m;
  object.cos_h = pose.cos_h;
  object.sin_h = pose.sin_h;
}

void give_form(core::Object& object, const Form& form) noexcept {
  object.kind = form.box ? core::Object::Kind::Box : core::Object::Kind::Cylinder;
  object.movable = form.movable;
  object.half_x_m = form.half_x_m;
  object.half_y_m = form.half_y_m;
  object.radius_m = form.radius_m;
  object.z_high_m = object.z_low_m + form.height_m;
  object.mass_kg = form.mass_kg;
}

std::string text_of(const hal::Status& status) {
  return status.ok() ? std::string() : status.error().message;
}

hal::Rgb rgb_of(Rgb8 color) noexcept {
  return {color.r, color.g, color.b};
}
core::Sketch::Pen pen_of(const Ink& ink) noexcept {
  return {rgb_of(ink.color), ink.width_m, ink.filled, ink.opacity};
}
core::Sketch::Point point_of(const Point& p) noexcept {
  return {p[0], p[1], p[2]};
}
std::vector<core::Sketch::Point> points_of(const std::vector<Point>& points) {
  std::vector<core::Sketch::Point> all;
  for (const Point& p : points) all.push_back(point_of(p));
  return all;
}

/// Calls `take` with what the robot sends, through either port. @returns what it returns; false: it has no such port
template <class Take>
bool with_message(core::Space& space, core::RobotId robot, Take&& take) {
  if (auto* const many = space.port<hal::RangeAndBearingLongSend>(robot)) return take(*many);
  auto* const plain = space.port<hal::RangeAndBearingSend>(robot);
  return plain != nullptr && take(*plain);
}

/// Tandem gives an id once in a run, ARGoS again: the second "x" is "x~2" in the world.
std::string next_id(const std::string& id, int number) {
  return number == 1 ? id : id + "~" + std::to_string(number);
}
constexpr int kMostOfOneId = 1'000'000;

}  // namespace

bool WorldAdapter::look(core::HookContext& context, std::uint32_t clock, Phase phase) {
  space_ = &context.space;
  checkpoints_ = &context.checkpoints;
  scenario_ = &context.scenario;
  ticks_per_second_ = static_cast<double>(context.ticks_per_second);
  seed_ = context.seed;
  const bool begins = clock != clock_ || phase != phase_;
  clock_ = clock;
  phase_ = phase;
  return begins;
}

bool WorldAdapter::repeats() const {
  return scenario_->seed.has_value();
}
std::uint32_t WorldAdapter::longest() const {
  return static_cast<std::uint32_t>(scenario_->length_s * static_cast<double>(scenario_->ticks_per_second) + 1e-6);
}
std::uint32_t WorldAdapter::threads() const {
  return static_cast<std::uint32_t>(scenario_->threads);
}
std::unique_ptr<ticpp::Element> WorldAdapter::experiment() const {
  return to_node(scenario_->effective, true);
}
void WorldAdapter::reset(std::uint64_t seed) {
  checkpoints_->reset(seed);
}
void WorldAdapter::warn(const std::string& text) {
  std::cerr << "warning: " << text << std::endl;
}
Point WorldAdapter::arena_center() const {
  const core::SpaceStores& s = space_->stores();
  return {space_->arena_center_x_m(), space_->arena_center_y_m(), std::isfinite(s.max_z_m) ? 0.5 * s.max_z_m : 0.0};
}
Point WorldAdapter::arena_size() const {
  const core::SpaceStores& s = space_->stores();
  return {space_->arena_size_x_m(), space_->arena_size_y_m(), std::isfinite(s.max_z_m) ? s.max_z_m : 0.0};
}

// --- bodies ---

std::vector<WorldDoor::Named> WorldAdapter::robots() const {
  std::vector<Named> all;
  for (std::size_t i = 0; i < space_->robot_count(); ++i) {
    const core::RobotId id = space_->robot(i);
    all.push_back({body_of(id), space_->robot_name(id), space_->kind(id).name, {}});
  }
  return all;
}
std::vector<WorldDoor::Named> WorldAdapter::objects() const {
  std::vector<Named> all;
  const std::vector<core::Object>& objects = space_->objects();
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (!objects[i].alive) continue;
    all.push_back({body_of(space_->object(i)),
                   objects[i].id,
                   objects[i].kind == core::Object::Kind::Box ? "box" : "cylinder",
                   {}});
  }
  return all;
}
Body WorldAdapter::find_robot(const std::string& id) const {
  return body_of(space_->find_robot(id));
}
Body WorldAdapter::find_object(const std::string& id) const {
  const core::ObjectId found = space_->find_object(id);
  return space_->contains(found) ? body_of(found) : Body();
}
bool WorldAdapter::there(const Body& body) const {
  return body.Kind == Body::ROBOT ? space_->contains(robot_id(body)) : space_->contains(object_id(body));
}

std::string WorldAdapter::id_in_world(const Body& robot) const {
  return space_->robot_name(robot_id(robot));
}

Place WorldAdapter::place(const Body& body) const {
  if (body.Kind == Body::ROBOT) {
    const core::Pose p = space_->pose(robot_id(body));
    return place_at(p.x_m, p.y_m, p.z_m, p.cos_h, p.sin_h);
  }
  const core::SpaceStores& s = space_->stores();
  const core::Object& o = s.objects[body.Index];
  const std::array<double, 4>& q = core::turn_of(s, o);
  if (!core::leans(q)) return place_at(o.x_m, o.y_m, o.z_low_m, o.cos_h, o.sin_h);
  const core::Attitude a = core::attitude_of(o, q);
  const double half_m = 0.5 * (o.z_high_m - o.z_low_m);
  return {a.middle_m[0] - half_m * a.axes[2][0],
          a.middle_m[1] - half_m * a.axes[2][1],
          a.middle_m[2] - half_m * a.axes[2][2],
          q[0],
          q[1],
          q[2],
          q[3]};
}

Form WorldAdapter::form(const Body& body) const {
  Form form;
  if (body.Kind == Body::ROBOT) {
    const hal::RobotKind& kind = space_->kind(robot_id(body));
    form.radius_m = kind.body.radius_m;
    form.height_m = kind.body.height_m;
    return form;
  }
  const core::Object& o = space_->objects()[body.Index];
  return {o.kind == core::Object::Kind::Box,
          o.movable,
          o.half_x_m,
          o.half_y_m,
          o.radius_m,
          o.z_high_m - o.z_low_m,
          o.mass_kg};
}

void WorldAdapter::put(const Body& body, const Place& place) {
  if (body.Kind == Body::ROBOT) return space_->set_pose(robot_id(body), pose_of(place));
  core::Object object = space_->objects()[body.Index];
  put_at(object, place);
  (void)space_->set_object(object_id(body), object);  // `room` has said whether it can
}
std::string WorldAdapter::room(const Body& body, const Place& place) const {
  return text_of(body.Kind == Body::ROBOT ? space_->room_for(robot_id(body), pose_of(place))
                                          : space_->room_for(object_id(body), pose_of(place)));
}

std::string WorldAdapter::add_robot(const Named& robot, const Place& place, Body& added) {
  core::NewRobot wanted;
  wanted.kind = robot.kind;
  wanted.controller = robot.controller;
  wanted.pose = pose_of(place);
  wanted.may_overlap = true;
  for (int number = 1; number <= kMostOfOneId; ++number) {
    wanted.id = next_id(robot.id, number);
    if (space_->had(wanted.id)) continue;
    const auto made = space_->add_robot(wanted);
    if (!made.ok()) return made.error().message;
    added = body_of(made.value());
    return {};
  }
  return "its id was used too often";
}

std::string WorldAdapter::add_object(const std::string& id, const Form& form, const Place& place,
                                     const std::vector<Led>& leds, Body& added) {
  core::Object wanted;
  give_form(wanted, form);
  put_at(wanted, place);
  for (const Led& led : leds) wanted.leds.push_back({led.x_m, led.y_m, led.z_m, rgb_of(led.color)});
  for (int number = 1; number <= kMostOfOneId; ++number) {
    wanted.id = next_id(id, number);
    if (space_->had(wanted.id)) continue;
    auto made = space_->add_object(wanted);
    if (!made.ok()) {
      // What stands there may be in the way: it is made outside of the arena, where what cannot move may be, and moved.
      core::Object outside = wanted;
      outside.movable = false;
      outside.x_m = space_->arena_center_x_m() + 1e3 * (1.0 + space_->arena_size_x_m());
      const auto made_outside = space_->add_object(outside);
      if (!made_outside.ok()) return made.error().message;
      if (const hal::Status moved = space_->set_object(made_outside.value(), wanted); !moved.ok()) {
        space_->remove_object(made_outside.value());
        return moved.error().message;
      }
      made = made_outside;
    }
    added = body_of(made.value());
    return {};
  }
  return "its id was used too often";
}

std::string WorldAdapter::change(const Body& object, const Form& form) {
  core::Object changed = space_->objects()[object.Index];
  give_form(changed, form);
  return text_of(space_->set_object(object_id(object), changed));
}
void WorldAdapter::remove(const Body& body) {
  if (body.Kind == Body::ROBOT) space_->remove_robot(robot_id(body));
  if (body.Kind == Body::OBJECT) space_->remove_object(object_id(body));
}
void WorldAdapter::halt(const Body& robot, bool halted) {
  space_->set_halted(robot_id(robot), halted);
}

// --- devices ---

std::vector<Led> WorldAdapter::leds(const Body& body) const {
  std::vector<Led> all;
  if (body.Kind == Body::OBJECT) {
    for (const core::ObjectLed& led : space_->objects()[body.Index].leds)
      all.push_back({led.x_m, led.y_m, led.z_m, {led.color.r, led.color.g, led.color.b}});
    return all;
  }
  const auto* const part = there(body) ? space_->kind(robot_id(body)).part<hal::LedsPart>() : nullptr;
  if (part == nullptr) return all;
  const auto* const colors = std::as_const(*space_).port<hal::RingLeds>(robot_id(body));
  for (std::size_t i = 0; i < part->mounts.size(); ++i) {
    const hal::Rgb c = colors == nullptr ? hal::Rgb{} : colors->color(i);
    all.push_back({part->mounts[i].x_m, part->mounts[i].y_m, part->mounts[i].z_m, {c.r, c.g, c.b}});
  }
  return all;
}
bool WorldAdapter::set_led(const Body& body, std::size_t number, Rgb8 color) {
  if (body.Kind == Body::OBJECT) return space_->set_object_led(object_id(body), number, rgb_of(color)).ok();
  auto* const colors = space_->port<hal::RingLeds>(robot_id(body));
  if (colors == nullptr || number >= hal::RingLeds::kCapacity) return false;
  colors->set(number, rgb_of(color));
  return true;
}

double WorldAdapter::battery(const Body& robot) const {
  const auto charge = space_->battery(robot_id(robot));
  return charge.ok() ? charge.value() : 1.0;
}
std::string WorldAdapter::set_battery(const Body& robot, double charge) {
  return text_of(space_->set_battery(robot_id(robot), charge));
}

double WorldAdapter::turret_rad(const Body& robot) const {
  return space_->turret_rad(robot_id(robot));
}
std::vector<std::uint8_t> WorldAdapter::message(const Body& robot) const {
  std::vector<std::uint8_t> bytes(rab_bytes(robot), 0);
  with_message(*space_, robot_id(robot), [&](const auto& sends) {
    if (sends.sending) bytes.assign(sends.payload.begin(), sends.payload.begin() + sends.size);
    return true;
  });
  return bytes;
}
bool WorldAdapter::set_message(const Body& robot, const std::vector<std::uint8_t>& bytes) {
  return with_message(*space_, robot_id(robot), [&](auto& sends) {
    if (bytes.size() > sends.payload.size()) return false;
    sends.sending = !bytes.empty();
    sends.size = static_cast<std::uint8_t>(bytes.size());
    std::copy(bytes.begin(), bytes.end(), sends.payload.begin());
    return true;
  });
}
double WorldAdapter::rab_range_m(const Body& robot) const {
  if (robot.Kind != Body::ROBOT || !there(robot)) return 0.0;
  const core::SpaceStores& s = space_->stores();
  return s.groups[s.blocks[s.robots[robot.Index].block].group].rab_range_m;
}
std::size_t WorldAdapter::rab_bytes(const Body& robot) const {
  if (robot.Kind != Body::ROBOT || !there(robot)) return 0;
  const core::SpaceStores& s = space_->stores();
  return s.groups[s.blocks[s.robots[robot.Index].block].group].rab_payload;
}

double WorldAdapter::wheel_base_m(const Body& robot) const {
  if (robot.Kind != Body::ROBOT || !there(robot)) return 0.0;
  const auto* const drive = space_->kind(robot_id(robot)).part<hal::DifferentialDrive>();
  return drive == nullptr ? 0.0 : drive->wheel_base_m;
}
std::array<double, 2> WorldAdapter::wheels_m_s(const Body& robot) const {
  const auto* const wheels = std::as_const(*space_).port<hal::WheelSpeeds>(robot_id(robot));
  return wheels == nullptr ? std::array<double, 2>{} : std::array<double, 2>{wheels->left_m_s, wheels->right_m_s};
}
bool WorldAdapter::set_wheels_m_s(const Body& robot, const std::array<double, 2>& speeds) {
  auto* const wheels = space_->port<hal::WheelSpeeds>(robot_id(robot));
  if (wheels != nullptr) wheels->set(speeds[0], speeds[1]);
  return wheels != nullptr;
}

// --- lamps, the floor ---

std::vector<std::pair<std::size_t, Lamp>> WorldAdapter::lamps() const {
  std::vector<std::pair<std::size_t, Lamp>> all;
  const std::vector<core::LightSource>& lights = space_->lights();
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const core::LightSource& l = lights[i];
    if (l.alive) all.push_back({i, {l.id, l.x_m, l.y_m, l.z_m, l.intensity, {l.color.r, l.color.g, l.color.b}}});
  }
  return all;
}
std::string WorldAdapter::add_lamp(const Lamp& lamp, std::size_t& number) {
  core::LightSource light{lamp.id, lamp.x_m, lamp.y_m, lamp.z_m, lamp.intensity, rgb_of(lamp.color)};
  for (int again = 1; again <= kMostOfOneId; ++again) {
    light.id = next_id(lamp.id, again);
    if (space_->had(light.id)) continue;
    const auto made = space_->add_light(light);
    if (!made.ok()) return made.error().message;
    number = made.value();
    return {};
  }
  return "its id was used too often";
}
void WorldAdapter::set_lamp(std::size_t number, const Lamp& lamp) {
  core::LightSource light = space_->lights().at(number);
  light.x_m = lamp.x_m;
  light.y_m = lamp.y_m;
  light.z_m = lamp.z_m;
  light.intensity = lamp.intensity;
  light.color = rgb_of(lamp.color);
  space_->set_light(number, light);
}
void WorldAdapter::remove_lamp(std::size_t number) {
  space_->remove_light(number);
}
double WorldAdapter::floor(double x_m, double y_m) const {
  return space_->floor(x_m, y_m);
}
void WorldAdapter::repaint_floor() {
  space_->repaint_floor();
}

// --- drawings ---

void WorldAdapter::draw_line(const std::vector<Point>& points, const Ink& ink) {
  space_->sketch().path(points_of(points), pen_of(ink));
}
void WorldAdapter::draw_polygon(const std::vector<Point>& corners, const Ink& ink) {
  space_->sketch().polygon(points_of(corners), pen_of(ink));
}
void WorldAdapter::draw_circle(const Point& center, double radius_m, const Ink& ink) {
  space_->sketch().circle(point_of(center), radius_m, pen_of(ink));
}
void WorldAdapter::draw_text(const Point& at, const std::string& text, const Ink& ink) {
  space_->sketch().text(point_of(at), text, pen_of(ink));
}

}  // namespace tandem::compat::argos3

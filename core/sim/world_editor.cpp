#include "core/sim/world_editor.hpp"

#include <algorithm>
#include <cmath>

#include "core/sim/engine_factory.hpp"
#include "core/space/attitude.hpp"
#include "hal/angle.hpp"
#include "hal/rounded.hpp"

namespace tandem::core {
namespace {

bool finite(const Pose& p) noexcept {
  return std::isfinite(p.x_m) && std::isfinite(p.y_m) && std::isfinite(p.z_m) &&
         std::fabs(p.cos_h * p.cos_h + p.sin_h * p.sin_h - 1.0) < 1e-6;
}

/// The configuration's parameters with others in their place; "group.name" is a parameter of a group.
Element overridden(Element params, const std::vector<std::pair<std::string, std::string>>& others) {
  for (const auto& [path, value] : others) {
    Element* in = &params;
    std::string name = path;
    for (std::size_t dot = 0; (dot = name.find('.')) != std::string::npos; name.erase(0, dot + 1)) {
      const std::string group = name.substr(0, dot);
      auto found = std::find_if(in->children.begin(), in->children.end(),
                                [&](const Element& child) { return child.name == group; });
      if (found == in->children.end()) {
        found = in->children.emplace(found);
        found->name = group;
        found->file = params.file;
        found->line = params.line;
      }
      in = &*found;
    }
    std::erase_if(in->attributes, [&](const Element::Attribute& a) { return a.name == name; });
    in->attributes.push_back({name, value, params.line, "add_robot"});
  }
  return params;
}

/// A point of W in the frame of a body with this pose: from its centre, z from its base.
std::array<double, 3> in_frame(const Pose& body, const std::array<double, 3>& p_W) noexcept {
  const double dx = p_W[0] - body.x_m;
  const double dy = p_W[1] - body.y_m;
  return {body.cos_h * dx + body.sin_h * dy, body.cos_h * dy - body.sin_h * dx, p_W[2] - body.z_m};
}

Pose pose_of(const SpaceStores& s, BodyKey body) noexcept {
  const std::size_t i = body.index();
  if (body.is_object()) {
    const Object& o = s.objects[i];
    return {o.x_m, o.y_m, o.z_low_m, o.cos_h, o.sin_h};
  }
  const Bodies& b = s.bodies;
  return {b.x_m[i], b.y_m[i], b.motion.empty() ? 0.0 : b.motion[i].z_m, b.cos_h[i], b.sin_h[i]};
}

/// An object as it stands upright.
Obstacle upright(const Object& object) noexcept {
  Obstacle o = disc_at(object.x_m, object.y_m, object.reach_m());
  o.is_box = object.kind == Object::Kind::Box;
  o.half_x_m = object.half_x_m;
  o.half_y_m = object.half_y_m;
  o.cos_h = object.cos_h;
  o.sin_h = object.sin_h;
  o.z_low_m = object.z_low_m;
  o.z_high_m = object.z_high_m;
  return o;
}

Solid solid_of(const Object& object, const Attitude& attitude) noexcept {
  const bool round = object.kind == Object::Kind::Cylinder;
  return {attitude.axes,
          attitude.middle_m,
          {round ? object.radius_m : object.half_x_m, round ? object.radius_m : object.half_y_m,
           0.5 * (object.z_high_m - object.z_low_m)},
          round};
}

/// A motion at rest where the object stands.
Motion at_rest(const Object& object) noexcept {
  const double half_rad = 0.5 * std::atan2(object.sin_h, object.cos_h);
  Motion motion;
  motion.z_m = object.z_low_m;
  motion.q_WB = {std::cos(half_rad), 0.0, 0.0, std::sin(half_rad)};
  return motion;
}

bool same_body(const Object& a, const Object& b) noexcept {
  return a.kind == b.kind && a.half_x_m == b.half_x_m && a.half_y_m == b.half_y_m && a.radius_m == b.radius_m &&
         a.z_high_m - a.z_low_m == b.z_high_m - b.z_low_m && a.mass_kg == b.mass_kg && a.movable == b.movable;
}

}  // namespace

// --- who is where ---

bool WorldEditor::alive(BodyKey body) const noexcept {
  const std::size_t i = body.index();
  if (body.is_object()) return i < stores_.objects.size() && stores_.objects[i].alive;
  return i < stores_.bodies.size() && (stores_.bodies.flags[i] & kAlive) != 0;
}

std::string WorldEditor::name_of(BodyKey body) const {
  const std::size_t i = body.index();
  if (body.is_object()) {
    const Object& o = stores_.objects[i];
    return (o.kind == Object::Kind::Box ? "box '" : "cylinder '") + o.id + "'";
  }
  const RobotEntity& e = stores_.robots[stores_.bodies.entity[i]];
  return "robot '" + stores_.names[e.item].prefix + (e.number < 0 ? "" : std::to_string(e.number)) + "'";
}

Obstacle WorldEditor::obstacle_of(BodyKey body) {
  const std::size_t i = body.index();
  Obstacle o;
  if (body.is_object()) {
    const Object& object = stores_.objects[i];
    if (const auto& q_WB = turn_of(stores_, object); leans(q_WB)) {
      if (leaning_.size() <= i) leaning_.resize(i + 1);
      leaning_[i] = solid_of(object, attitude_of(object, q_WB));
      o = bounds_of(leaning_[i]);
    } else {
      o = upright(object);
    }
  } else {
    const Bodies& b = stores_.bodies;
    const hal::RobotKind& kind = *stores_.groups[stores_.blocks[stores_.robots[b.entity[i]].block].group].kind;
    o = disc_at(b.x_m[i], b.y_m[i], kind.body.radius_m);
    o.is_robot = true;
    o.flies = kind.flies();
    o.z_low_m = b.motion.empty() ? 0.0 : b.motion[i].z_m;
    o.z_high_m = o.z_low_m + kind.body.height_m;
  }
  o.item = body.value;
  return o;
}

std::optional<BodyKey> WorldEditor::in_the_way(const Obstacle& o, BodyKey self, bool of_immovable) {
  const auto enter = [&](BodyKey body) {
    if (!alive(body)) return;
    const Obstacle place = obstacle_of(body);
    if (std::isfinite(place.x_m + place.y_m + place.cos_h + place.sin_h))
      occupancy_->add(place);  // else a hook put it nowhere: the run ends by that
  };
  if (!occupancy_ || entered_version_ != stores_.poses_version) {
    double cell_m = 0.02;
    for (const RobotGroup& group : stores_.groups) cell_m = std::max(cell_m, 2.0 * group.kind->body.radius_m);
    occupancy_.emplace(cell_m);
    occupancy_->reserve(stores_.living.size() + stores_.objects.size());
    for (std::size_t row = 0; row < stores_.bodies.size(); ++row) enter(BodyKey::robot(row));
    for (std::size_t i = 0; i < stores_.objects.size(); ++i) enter(BodyKey::object(i));
    entered_version_ = stores_.poses_version;
    entered_ = stores_.touched.size();
  }
  for (; entered_ < stores_.touched.size(); ++entered_) enter(stores_.touched[entered_]);
  const Obstacle* found = occupancy_->hit(o, [&](const Obstacle& other) {
    const BodyKey body{other.item};
    if (body == self || !alive(body)) return false;
    if (of_immovable && body.is_object() && !stores_.objects[body.index()].movable) return false;
    return overlap(o, obstacle_of(body));
  });
  if (found == nullptr) return std::nullopt;
  return BodyKey{found->item};
}

std::uint16_t WorldEditor::region_now(BodyKey body) const noexcept {
  const std::size_t i = body.index();
  const bool known = body.is_object() ? stores_.object_region[i] != kNoRegion : (stores_.bodies.flags[i] & kMoved) == 0;
  if (!known) return assigner_.find(stores_, body);
  return body.is_object() ? stores_.object_region[i] : stores_.bodies.region[i];
}

hal::Status WorldEditor::check_place(const std::string& who, const Pose& pose) const {
  if (!finite(pose)) return hal::Error{who + " needs a finite position and a heading as cosine and sine"};
  if (pose.x_m < stores_.min_x_m || pose.x_m > stores_.max_x_m || pose.y_m < stores_.min_y_m ||
      pose.y_m > stores_.max_y_m)
    return hal::Error{who + " would be at " + hal::place_text(pose.x_m, pose.y_m) + ", outside the arena"};
  return {};
}

// --- robots ---

std::string WorldEditor::usual_kind(std::size_t controller) const {
  const std::vector<RobotItem>& robots = scenario_.robots;
  const auto same =
      std::find_if(robots.begin(), robots.end(), [&](const RobotItem& r) { return r.controller == controller; });
  if (same != robots.end()) return same->kind;
  return robots.empty() ? std::string() : robots.front().kind;
}

hal::Result<RobotItem> WorldEditor::item_for(const NewRobot& wanted) const {
  std::vector<std::string> ids;
  for (const ControllerConfig& config : scenario_.controllers) ids.push_back(config.id);
  const auto config = std::find(ids.begin(), ids.end(), wanted.controller);
  if (config == ids.end()) {
    return hal::Error{"robot '" + wanted.id + "': there is no controller with id '" + wanted.controller +
                      "'; there are: " + listed(ids) + did_you_mean(wanted.controller, ids)};
  }
  RobotItem item;
  item.controller = static_cast<std::size_t>(config - ids.begin());
  item.kind = wanted.kind.empty() ? usual_kind(item.controller) : wanted.kind;
  if (find_kind(scenario_, factory_.catalog(), item.kind) == nullptr) {
    const std::vector<std::string> kinds = kind_names(scenario_, factory_.catalog());
    return hal::Error{"robot '" + wanted.id + "': there is no kind '" + item.kind + "'; there are: " + listed(kinds) +
                      did_you_mean(item.kind, kinds)};
  }
  for (const RobotItem& like : scenario_.robots) {
    if (like.kind != item.kind || like.controller != item.controller) continue;
    item.battery = like.battery;
    item.own_kind = like.own_kind;
    break;
  }
  item.id = wanted.id;
  if (!wanted.params.empty()) item.params = overridden(scenario_.controllers[item.controller].params, wanted.params);
  return item;
}

hal::Status WorldEditor::accept(const std::string& who, std::size_t row, bool may_overlap) {
  const BodyKey self = BodyKey::robot(row);
  const Obstacle o = obstacle_of(self);
  if (const auto other = may_overlap ? std::nullopt : in_the_way(o, self, false))
    return hal::Error{who + " would be at " + hal::place_text(o.x_m, o.y_m) + ", where " + name_of(*other) + " is"};
  const std::uint16_t region = assigner_.find(stores_, self);
  if (region == kNoRegion) {
    return hal::Error{
        who + " would be at " + hal::place_text(o.x_m, o.y_m) + ", which lies in no region of an engine " +
        (o.flies ? "that can fly it; use " +
                       engines_that(factory_.catalog(), [](const EngineTraits& traits) { return !traits.plane; })
                 : "for it")};
  }
  stores_.bodies.region[row] = region;
  return {};
}

hal::Result<RobotId> WorldEditor::add_robot(const NewRobot& wanted) {
  const std::string who = "robot '" + wanted.id + "'";
  if (const hal::Status placed = check_place(who, wanted.pose); !placed.ok()) return placed.error();
  const hal::Result<RobotItem> item = item_for(wanted);
  if (!item.ok()) return item.error();
  return factory_.add(item.value(), wanted.pose, [&](std::size_t row) { return accept(who, row, wanted.may_overlap); });
}

// --- objects ---

hal::Status WorldEditor::check_shape(const Object& object) const {
  const std::string who = (object.kind == Object::Kind::Box ? "box '" : "cylinder '") + object.id + "'";
  const bool box = object.kind == Object::Kind::Box;
  const double a = box ? object.half_x_m : object.radius_m;
  const double b = box ? object.half_y_m : object.radius_m;
  const double height = object.z_high_m - object.z_low_m;
  if (!(a > 0.0 && b > 0.0 && height > 0.0 && std::isfinite(a) && std::isfinite(b) && std::isfinite(height)))
    return hal::Error{who + (box ? " needs half_x_m, half_y_m" : " needs radius_m") + " and a height above 0"};
  if (object.movable && !(object.mass_kg > 0.0 && std::isfinite(object.mass_kg)))
    return hal::Error{who + " is movable: it needs a mass above 0"};
  const Pose pose{object.x_m, object.y_m, object.z_low_m, object.cos_h, object.sin_h};
  if (object.movable) return check_place(who, pose);
  return finite(pose) ? hal::Status{}
                      : hal::Status(hal::Error{who + " needs a finite position and a heading as cosine and sine"});
}

/// Whether the region's engine can move it.
hal::Status WorldEditor::check_mover(const Object& object, std::uint16_t region) const {
  const std::string who = (object.kind == Object::Kind::Box ? "box '" : "cylinder '") + object.id + "'";
  if (region == kNoRegion) {
    return hal::Error{who + " would be at " + hal::place_text(object.x_m, object.y_m) +
                      ", in no region of an engine that moves objects; use " +
                      engines_that(factory_.catalog(), [](const EngineTraits& traits) { return traits.forces; })};
  }
  if (scenario_.engines.empty()) return {};
  const std::string why = unfit_for(factory_.catalog(), scenario_.engines[stores_.regions[region].engine].kind, object);
  return why.empty() ? hal::Status{} : hal::Status(hal::Error{who + " " + why});
}

hal::Result<ObjectId> WorldEditor::add_object(const Object& wanted) {
  if (const hal::Status shape = check_shape(wanted); !shape.ok()) return shape.error();
  const std::size_t number = stores_.objects.size();
  const BodyKey self = BodyKey::object(number);
  stores_.objects.push_back(wanted);
  stores_.object_motion.push_back(at_rest(wanted));
  stores_.object_region.push_back(kNoRegion);
  Object& object = stores_.objects.back();
  object.alive = true;
  object.version = 0;
  hal::Status fits;
  const std::string would_be = name_of(self) + " would be at " + hal::place_text(object.x_m, object.y_m);
  if (const auto other = in_the_way(obstacle_of(self), self, !object.movable)) {
    fits = hal::Error{would_be + ", where " + name_of(*other) + " is"};
  } else if (object.movable) {
    stores_.object_region.back() = assigner_.find(stores_, self);
    fits = check_mover(object, stores_.object_region.back());
  }
  if (!fits.ok()) {
    stores_.objects.pop_back();
    stores_.object_motion.pop_back();
    stores_.object_region.pop_back();
    return fits.error();
  }
  object.generation = ++stores_.generations;
  stores_.object_numbers.emplace(object.id, self.index());
  stores_.altered = true;
  if (!object.movable) ++stores_.immovables_version;
  stores_.touch(self);
  return ObjectId{static_cast<std::uint32_t>(number), object.generation};
}

hal::Status WorldEditor::set_object(ObjectId id, const Object& changed) {
  Object next = changed;
  Object& object = stores_.objects[id.index];
  next.id = object.id;
  next.alive = true;
  next.generation = object.generation;
  if (const hal::Status shape = check_shape(next); !shape.ok()) return shape;
  const BodyKey self = BodyKey::object(id.index);
  const Object before = object;
  next.version = before.version + (same_body(before, next) ? 0 : 1);
  object = next;
  if (next.movable) {
    const std::uint16_t region = assigner_.find(stores_, self);
    if (const hal::Status fits = check_mover(next, region); !fits.ok()) {
      object = before;
      return fits;
    }
    stores_.object_region[id.index] = region;
  }
  Motion motion = at_rest(object);
  if (next.movable && before.movable) {
    motion.v_m_s = stores_.object_motion[id.index].v_m_s;
    motion.w_rad_s = stores_.object_motion[id.index].w_rad_s;
  }
  stores_.object_motion[id.index] = motion;
  if (!next.movable) {
    for (Joint& joint : stores_.joints) joint.alive = joint.alive && joint.a != self && joint.b != self;
  }
  if (!before.movable || !next.movable) {
    ++stores_.immovables_version;
    stores_.altered = true;
  }
  if (!before.leds.empty() || !next.leds.empty()) {
    ++stores_.object_leds_version;
    stores_.altered = true;
  }
  stores_.touch(self);
  return {};
}

hal::Status WorldEditor::room_for(BodyKey body, const Pose& pose) {
  const std::string who = name_of(body);
  const bool fixed = body.is_object() && !stores_.objects[body.index()].movable;
  if (fixed && !finite(pose)) return hal::Error{who + " needs a finite position and a heading as cosine and sine"};
  if (!fixed) {
    if (const hal::Status placed = check_place(who, pose); !placed.ok()) return placed;
  }
  // An object that is put somewhere stands upright there.
  Obstacle place = body.is_object() ? upright(stores_.objects[body.index()]) : obstacle_of(body);
  const double height_m = place.z_high_m - place.z_low_m;
  place.x_m = pose.x_m;
  place.y_m = pose.y_m;
  place.z_low_m = pose.z_m;
  place.z_high_m = pose.z_m + height_m;
  if (place.is_box) {
    place.cos_h = pose.cos_h;
    place.sin_h = pose.sin_h;
  }
  if (const auto other = in_the_way(place, body, fixed))
    return hal::Error{who + " would be at " + hal::place_text(pose.x_m, pose.y_m) + ", where " + name_of(*other) +
                      " is"};
  if (fixed || region_at(body, pose) != kNoRegion) return {};
  return hal::Error{who + " would be at " + hal::place_text(pose.x_m, pose.y_m) +
                    ", which lies in no region of an engine that can move it"};
}

/// Found for the body as it would stand there; it then stands where it did.
std::uint16_t WorldEditor::region_at(BodyKey body, const Pose& pose) {
  const std::size_t i = body.index();
  Bodies& b = stores_.bodies;
  const Pose was = pose_of(stores_, body);
  const auto stand = [&](const Pose& at) {
    if (body.is_object()) {
      Object& object = stores_.objects[i];
      object.z_high_m += at.z_m - object.z_low_m;
      object.x_m = at.x_m;
      object.y_m = at.y_m;
      object.z_low_m = at.z_m;
      return;
    }
    b.x_m[i] = at.x_m;
    b.y_m[i] = at.y_m;
    if (!b.motion.empty()) b.motion[i].z_m = at.z_m;
  };
  const double high_m = body.is_object() ? stores_.objects[i].z_high_m : 0.0;
  stand(pose);
  const std::uint16_t region = assigner_.find(stores_, body);
  stand(was);
  if (body.is_object()) stores_.objects[i].z_high_m = high_m;  // to the bit
  return region;
}

// --- joints ---

hal::Result<JointId> WorldEditor::join(BodyKey a, BodyKey b, const std::array<double, 3>& p_W, const JointForm& form) {
  for (const BodyKey body : {a, b}) {
    const std::uint16_t region = region_now(body);
    if (region == kNoRegion) return hal::Error{name_of(body) + " cannot be joined: it lies in no engine's region"};
    const std::string why = lacks_joints(factory_.catalog(), stores_.regions[region], bit(form.kind));
    if (!why.empty()) return hal::Error{name_of(body) + " cannot be joined: " + why};
  }
  const Region& region = stores_.regions[region_now(std::min(a, b))];
  if (form.kind == JointKind::Sliding && region.plane && form.axis[2] != 0.0) {
    return hal::Error{name_of(b) + " cannot slide out of the plane: its engine '" + region.name +
                      "' keeps bodies on the ground; use " +
                      engines_that(factory_.catalog(), [](const EngineTraits& traits) {
                        return !traits.plane && traits.has(bit(JointKind::Sliding));
                      })};
  }
  const Pose pose_a = pose_of(stores_, a);
  const Pose pose_b = pose_of(stores_, b);
  const std::array<double, 3> in_a = in_frame(pose_a, p_W);
  const std::array<double, 3> in_b = in_frame(pose_b, p_W);
  Joint joint;
  joint.alive = true;
  joint.generation = ++stores_.joint_generations;
  joint.a = a;
  joint.b = b;
  joint.ax_m = in_a[0];
  joint.ay_m = in_a[1];
  joint.az_m = in_a[2];
  joint.bx_m = in_b[0];
  joint.by_m = in_b[1];
  joint.bz_m = in_b[2];
  joint.form = form;
  const std::array<double, 3>& axis = form.axis;
  joint.form.axis = {pose_a.cos_h * axis[0] + pose_a.sin_h * axis[1], pose_a.cos_h * axis[1] - pose_a.sin_h * axis[0],
                     axis[2]};
  joint.heading_rad = hal::turn_between(pose_a.heading_rad(), pose_b.heading_rad());
  const auto unused =
      std::find_if(stores_.joints.begin(), stores_.joints.end(), [](const Joint& j) { return !j.alive; });
  const auto number = static_cast<std::uint32_t>(unused - stores_.joints.begin());
  if (unused == stores_.joints.end()) {
    stores_.joints.push_back(joint);
  } else {
    *unused = joint;
  }
  stores_.bodies_changed = true;
  return JointId{number, joint.generation};
}

}  // namespace tandem::core

#include "window/frame_encoder.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <utility>

namespace tandem::window {
namespace {

using hal::Json;

constexpr std::size_t kHeaderBytes = 32;

// The wire is little-endian, as all machines are that this program is built for.
template <class T>
void put(char*& out, T value) noexcept {
  std::memcpy(out, &value, sizeof value);
  out += sizeof value;
}

Message text_message(const Json& json) {
  return {std::make_shared<const std::string>(hal::to_text(json)), false};
}

/// RGB565 of the mean of those that are lit; never 0 where one is.
std::uint16_t mixed(const hal::Rgb* led, const hal::Rgb* end) noexcept {
  unsigned r = 0, g = 0, b = 0, lit = 0;
  for (; led != end; ++led) {
    r += led->r;
    g += led->g;
    b += led->b;
    lit += *led == hal::kBlack ? 0U : 1U;
  }
  if (lit == 0) return 0;
  r /= lit;
  g /= lit;
  b /= lit;
  const unsigned packed = (r >> 3) << 11 | (g >> 2) << 5 | b >> 3;
  return static_cast<std::uint16_t>(std::max(packed, 1U));
}

std::uint8_t signed_part(double angle_rad) noexcept {
  const double part = std::clamp(angle_rad / (0.5 * std::numbers::pi) * 128.0, -128.0, 127.0);
  return static_cast<std::uint8_t>(static_cast<std::int8_t>(std::lround(part)));
}

/// Roll and pitch of an attitude (x forward, then y left, turning about z last).
std::pair<std::uint8_t, std::uint8_t> lean(const std::array<float, 4>& q_WB) noexcept {
  const double w = q_WB[0], x = q_WB[1], y = q_WB[2], z = q_WB[3];
  if (x == 0.0 && y == 0.0) return {0, 0};  // as nearly everybody is
  return {signed_part(std::atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y))),
          signed_part(std::asin(std::clamp(2.0 * (w * y - z * x), -1.0, 1.0)))};
}

}  // namespace

// [Abramowitz & Stegun 1964, 4.4.47]: arctan on [0, 1] within 1e-5, a tenth of the last digit that is sent.
std::uint16_t turns_of(double cos, double sin) noexcept {
  const double c = std::abs(cos), s = std::abs(sin);
  const double large = std::max(c, s), small = std::min(c, s);
  const double t = large > 0.0 ? small / large : 0.0;
  const double t2 = t * t;
  double angle = t * (0.9998660 + t2 * (-0.3302995 + t2 * (0.1801410 + t2 * (-0.0851330 + t2 * 0.0208351))));
  angle = s > c ? 0.5 * std::numbers::pi - angle : angle;
  angle = cos < 0.0 ? std::numbers::pi - angle : angle;
  angle = sin < 0.0 ? -angle : angle;
  return static_cast<std::uint16_t>(static_cast<std::int32_t>(angle * (32768.0 / std::numbers::pi) + 65536.5));
}

Frame FrameEncoder::take(Frame&& frame) {
  const bool other_members = frame.members != frame_.members;
  const bool other_scene = frame.scene != frame_.scene;
  std::swap(frame_, frame);
  ++number_;
  poses_ = {};
  leds_of_.clear();
  values_of_.clear();
  objects_of_.clear();
  if (other_members) {
    members_ = {};
    leds_.forget();
    values_.forget();
  }
  if (other_scene) {
    scene_ = {};
    objects_.clear();
  }
  const bool leds_shown = frame_.members != nullptr && frame_.members->size() <= kMostRobotsWithLeds;
  leds_.note(frame_.leds.data(), leds_shown ? frame_.leds.size() : 0, number_);
  values_.note(frame_.values.data(), frame_.values.size(), number_);
  note_objects();
  note_marks();
  for (FrameLayer& layer : frame_.layers) {
    std::string lines = header(3, layer.index, layer.segments.size());
    const std::size_t at = lines.size();
    lines.resize(at + layer.segments.size() * sizeof(core::Segment));
    if (!layer.segments.empty())
      std::memcpy(lines.data() + at, layer.segments.data(), layer.segments.size() * sizeof(core::Segment));
    Layer& now = layers_[layer.index];
    const bool had_texts = now.texts.bytes != nullptr;
    now.drawing = ++drawings_;
    now.lines = {std::make_shared<const std::string>(std::move(lines)), true};
    now.texts = {};
    if (had_texts || !layer.texts.is_null()) {
      now.texts = text_message({{"type", "texts"},
                                {"layer", layer.index},
                                {"texts", layer.texts.is_null() ? Json::array() : std::move(layer.texts)}});
    }
  }
  return std::move(frame);
}

void FrameEncoder::note_objects() {
  for (const FrameObject& object : frame_.objects) {
    auto& [known, changed] = objects_[object.number];
    const bool same = changed != 0 && known.x_m == object.x_m && known.y_m == object.y_m && known.z_m == object.z_m &&
                      known.heading_rad == object.heading_rad;
    if (same) continue;
    known = object;
    changed = number_;
  }
}

void FrameEncoder::note_marks() {
  if (marks_.bytes != nullptr && halted_ == frame_.halted) return;
  halted_ = frame_.halted;
  ++marks_version_;
  marks_ = text_message({{"type", "marks"}, {"halted", halted_}});
}

std::string FrameEncoder::header(std::uint32_t type, std::uint32_t number, std::size_t count) const {
  std::string bytes(kHeaderBytes, '\0');
  char* out = bytes.data();
  put(out, type);
  put(out, number);
  put(out, frame_.tick);
  put(out, static_cast<std::uint32_t>(count));
  put(out, frame_.members != nullptr ? frame_.members->number : 0U);
  put(out, frame_.time_s);
  return bytes;
}

Message FrameEncoder::poses() const {
  const std::size_t count = frame_.x_m.size();
  std::string bytes = header(1, number_, count);
  const std::size_t at = bytes.size();
  bytes.resize(at + count * kRowBytes);
  char* out = bytes.data() + at;
  const std::uint32_t* const first_led = frame_.members != nullptr ? frame_.members->first_led.data() : nullptr;
  for (std::size_t i = 0; i < count; ++i) {
    put(out, static_cast<float>(frame_.x_m[i]));
    put(out, static_cast<float>(frame_.y_m[i]));
    std::uint16_t z_mm = 0;
    if (!frame_.z_m.empty()) {
      const float mm = frame_.z_m[i] * 1000.0F + 0.5F;
      z_mm = mm >= 65000.0F ? 65535 : mm > 0.0F ? static_cast<std::uint16_t>(mm) : 0;
    }
    put(out, z_mm);
    put(out, turns_of(frame_.cos_h[i], frame_.sin_h[i]));
    std::uint16_t color = 0;
    if (first_led != nullptr && first_led[i + 1] <= frame_.leds.size())
      color = mixed(frame_.leds.data() + first_led[i], frame_.leds.data() + first_led[i + 1]);
    put(out, color);
    const auto [roll, pitch] = frame_.q_WB.empty() ? std::pair<std::uint8_t, std::uint8_t>{} : lean(frame_.q_WB[i]);
    put(out, roll);
    put(out, pitch);
  }
  return {std::make_shared<const std::string>(std::move(bytes)), true};
}

/// Entries: the member, and what `put(out, number, value)` writes of a value of its.
template <class T, class Put>
Message FrameEncoder::changes_since(std::uint32_t frame, std::uint32_t type, const std::vector<std::uint32_t>& first,
                                    const Changing<T>& values, Put&& put_value) const {
  std::string bytes = header(type, number_, 0);
  std::uint32_t count = 0;
  for (std::uint32_t member = 0; member + 1 < first.size(); ++member) {
    for (std::uint32_t i = first[member]; i < first[member + 1] && i < values.known.size(); ++i) {
      if (values.changed[i] <= frame) continue;
      ++count;
      char entry[16];
      char* out = entry;
      put(out, member);
      put_value(out, i - first[member], values.known[i]);
      bytes.append(entry, out);
    }
  }
  if (count == 0) return {};
  constexpr std::size_t kCountAt = 16;
  std::memcpy(bytes.data() + kCountAt, &count, sizeof count);
  return {std::make_shared<const std::string>(std::move(bytes)), true};
}

Message FrameEncoder::objects_since(std::uint32_t frame) const {
  Json poses = Json::array();
  for (const auto& [number, entry] : objects_) {
    const auto& [object, changed] = entry;
    if (changed > frame) poses.push_back({number, object.x_m, object.y_m, object.z_m, object.heading_rad});
  }
  if (poses.empty()) return {};
  return text_message({{"type", "objects"}, {"tick", frame_.tick}, {"poses", std::move(poses)}});
}

void FrameEncoder::update(ViewerState& viewer, const std::vector<std::uint32_t>& layers, std::vector<Message>& out) {
  if (number_ == 0) return;
  std::uint32_t of_members_from = viewer.frame, objects_from = viewer.frame;
  if (frame_.scene != nullptr && viewer.scene != frame_.scene->number) {
    if (scene_.bytes == nullptr) {
      Json scene = {{"type", "scene"}};
      scene.update(frame_.scene->json);
      scene["floor"] = frame_.scene->floor != nullptr
                           ? Json("/floor.png?v=" + std::to_string(frame_.scene->number) + file_suffix_)
                           : Json();
      scene_ = text_message(scene);
    }
    out.push_back(scene_);
    viewer.scene = frame_.scene->number;
    objects_from = 0;
  }
  if (frame_.members != nullptr && viewer.members != frame_.members->number) {
    if (members_.bytes == nullptr) {
      Json members = {{"type", "members"}, {"members", frame_.members->number}};
      members.update(frame_.members->json);
      members_ = text_message(members);
    }
    out.push_back(members_);
    viewer.members = frame_.members->number;
    viewer.marks = 0;
    of_members_from = 0;
  }
  if (viewer.marks != marks_version_) {
    out.push_back(marks_);
    viewer.marks = marks_version_;
  }
  if (viewer.frame != number_) {
    const auto shared = [](std::map<std::uint32_t, Message>& made, std::uint32_t since, const auto& make) -> Message& {
      const auto [entry, fresh] = made.try_emplace(since);
      if (fresh) entry->second = make();
      return entry->second;
    };
    if (!objects_.empty()) {
      const Message& moved = shared(objects_of_, objects_from, [&] { return objects_since(objects_from); });
      if (moved.bytes != nullptr) out.push_back(moved);
    }
    if (!leds_.known.empty()) {
      const Message& lit = shared(leds_of_, of_members_from, [&] {
        return changes_since(of_members_from, 2, frame_.members->first_led, leds_,
                             [](char*& to, std::uint32_t led, hal::Rgb color) {
                               put(to, static_cast<std::uint8_t>(led));
                               put(to, color);
                             });
      });
      if (lit.bytes != nullptr) out.push_back(lit);
    }
    if (!values_.known.empty()) {
      const Message& moved = shared(values_of_, of_members_from, [&] {
        return changes_since(of_members_from, 4, frame_.members->first_value, values_,
                             [](char*& to, std::uint32_t number, float value) {
                               put(to, number);
                               put(to, value);
                             });
      });
      if (moved.bytes != nullptr) out.push_back(moved);
    }
    if (poses_.bytes == nullptr) poses_ = poses();
    out.push_back(poses_);
    viewer.frame = number_;
  }
  for (const std::uint32_t index : layers) {
    const auto layer = layers_.find(index);
    if (layer == layers_.end() || viewer.layers[index] == layer->second.drawing) continue;
    viewer.layers[index] = layer->second.drawing;
    out.push_back(layer->second.lines);
    if (layer->second.texts.bytes != nullptr) out.push_back(layer->second.texts);
  }
}

}  // namespace tandem::window

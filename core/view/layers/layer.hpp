// Layers: drawings over a space and panels beside it, on request.
//
//   class Reach final : public core::Layer {
//    public:
//     void draw(const core::LayerView& now, core::Sketch& out) override {
//       for (const core::RobotId robot : now.robots) out.circle(core::center_of(now.space.pose(robot)), 0.2);
//     }
//   };
//   static const core::LayerType type = core::layer_type<Reach>("reach", "How far each robot reaches.");
#pragma once
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/record/observer.hpp"
#include "core/space/ids.hpp"
#include "core/space/sketch.hpp"
#include "core/space/stores.hpp"
#include "hal/unit.hpp"

namespace tandem::core {

/// What a layer sees: the state at the end of a tick, and the robots that are asked for, at most some thousand.
struct LayerView : Observation {
  std::span<const RobotId> robots;
};

/// A table of a few lines beside the drawing.
class Panel {
 public:
  struct Row {
    std::string label, value, unit;
  };

  void row(std::string_view label, std::string_view value) {
    rows_.push_back({std::string(label), std::string(value), {}});
  }
  /// A number, shown in `unit`, with six digits.
  void row(std::string_view label, double value_si, const hal::Unit& unit = hal::unit::none);
  /// The layer's name unless it says otherwise.
  void set_title(std::string_view title) { title_ = title; }

  const std::string& title() const noexcept { return title_; }
  const std::vector<Row>& rows() const noexcept { return rows_; }

 private:
  std::string title_;
  std::vector<Row> rows_;
};

/// Looks at the world and changes nothing of it. Called between steps by the thread that steps, and only while somebody
/// has switched the layer on. What it throws is told once; the layer is then off for good. Keeps no reference to what
/// it was shown: a run may start again with another space, and may go back to an earlier tick.
class Layer {
 public:
  Layer() noexcept { hal::detail::note_surface<StoresSurface>(); }
  virtual ~Layer() = default;

  /// After every tick, for what depends on the past. Keep it short: it slows the run.
  virtual void note(const LayerView& /*now*/) {}
  /// When a frame is due. `out` is empty.
  virtual void draw(const LayerView& /*now*/, Sketch& /*out*/) {}
  /// When a frame is due, a few times a second. `out` is empty.
  virtual void panel(const LayerView& /*now*/, Panel& /*out*/) {}
};

/// A class of layers: what a plug-in registers.
struct LayerType {
  static constexpr std::string_view kCategory = "layer";
  using Crosses = hal::Layouts<Layer, LayerView, Panel, Panel::Row, Sketch, Sketch::Shape, Sketch::Point>;
  std::string_view name;
  std::string_view summary;
  std::unique_ptr<Layer> (*make)() = nullptr;
  bool draws = false;                              ///< it has something to draw
  bool panels = false;                             ///< it has a panel
  bool notes = false;                              ///< it wants every tick
  std::span<const std::string_view> sensors = {};  ///< it shows nothing but readings of these; empty: something else
};

/// The table of layer class `T`, whose functions are public, and which is constructed from nothing. `T::kSensors` may
/// be an array of the names of the sensors whose readings are all that it shows.
template <class T>
LayerType layer_type(std::string_view name, std::string_view summary) {
  LayerType type;
  type.name = name;
  type.summary = summary;
  type.make = []() -> std::unique_ptr<Layer> { return std::make_unique<T>(); };
  type.draws = !std::is_same_v<decltype(&T::draw), decltype(&Layer::draw)>;
  type.panels = !std::is_same_v<decltype(&T::panel), decltype(&Layer::panel)>;
  type.notes = !std::is_same_v<decltype(&T::note), decltype(&Layer::note)>;
  if constexpr (requires { T::kSensors; }) type.sensors = T::kSensors;
  return type;
}

// --- for drawing ---

/// A point of a body in W: `p_B` is in the body frame, from the centre of the base.
inline Sketch::Point point_of(const Pose& body, const Sketch::Point& p_B) noexcept {
  return {body.x_m + body.cos_h * p_B.x_m - body.sin_h * p_B.y_m,
          body.y_m + body.sin_h * p_B.x_m + body.cos_h * p_B.y_m, body.z_m + p_B.z_m};
}

/// The middle of a body's base.
inline Sketch::Point center_of(const Pose& body) noexcept {
  return {body.x_m, body.y_m, body.z_m};
}

/// Colours that colour-blind people can tell apart [Okabe and Ito 2008, "Color universal design"].
namespace ink {
inline constexpr hal::Rgb kOrange{230, 159, 0};
inline constexpr hal::Rgb kSky{86, 180, 233};
inline constexpr hal::Rgb kGreen{0, 158, 115};
inline constexpr hal::Rgb kYellow{240, 228, 66};
inline constexpr hal::Rgb kBlue{0, 114, 178};
inline constexpr hal::Rgb kRed{213, 94, 0};
inline constexpr hal::Rgb kPurple{204, 121, 167};
}  // namespace ink

}  // namespace tandem::core

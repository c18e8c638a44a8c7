// A physics engine: robots on wheels drift with the water of a river. They do not touch one another.
#include <cmath>
#include <numbers>

#include "core/physics/solver.hpp"
#include "hal/elementary.hpp"
#include "hal/plugin.hpp"

namespace {

using namespace tandem;

struct Params {
  std::array<double, 3> current_m_s{0.1, 0.0, 0.0};
  double width_m = 4.0;
  void describe(hal::ParamVisitor& v) {
    v.vector("current", current_m_s, hal::unit::m_s, "Of the water in the middle of the river, x and y.");
    v.number("width", width_m, hal::unit::m, {0.01, 1e4}, "Of the river; it flows along y = 0.");
  }
};

/// The bodies of one region. Regions are stepped in parallel: each writes the rows that it owns and nothing else.
class River final : public core::Solver {
 public:
  explicit River(const Params& params) : params_(params) {}

  void load(const core::SolverContext&) override {}  // it keeps nothing of its own: the stores are all there is

  void advance(const core::SolverContext& context) override {
    core::SpaceStores& stores = context.stores;
    core::Bodies& b = stores.bodies;
    for (const core::BodyKey body : context.region.owned) {
      if (body.is_object()) continue;  // objects do not float
      const std::size_t row = body.index();
      if (stores.led_or_held(row)) continue;  // a real robot's twin: its pose comes from outside
      const double left_m = b.left_m_s[row] * context.tick_s, right_m = b.right_m_s[row] * context.tick_s;
      const double way_m = 0.5 * (left_m + right_m);
      const double turn_rad = (right_m - left_m) / stores.kind_of_row(row).drive()->wheel_base_m;
      const double across = b.y_m[row] / (0.5 * params_.width_m);
      const double flow = std::max(0.0, 1.0 - across * across) * context.tick_s;
      if (!std::isfinite(way_m) || !std::isfinite(turn_rad)) {
        trouble.push_back({body, "has wheel speeds that are no numbers"});
        continue;
      }
      b.x_m[row] += b.cos_h[row] * way_m + params_.current_m_s[0] * flow;
      b.y_m[row] += b.sin_h[row] * way_m + params_.current_m_s[1] * flow;
      const double c = hal::cos(turn_rad), s = hal::sin(turn_rad), cos_h = b.cos_h[row], sin_h = b.sin_h[row];
      const double length = hal::hypot(cos_h * c - sin_h * s, sin_h * c + cos_h * s);
      b.cos_h[row] = (cos_h * c - sin_h * s) / length;
      b.sin_h[row] = (sin_h * c + cos_h * s) / length;
      b.left_m[row] += left_m;
      b.right_m[row] += right_m;
    }
  }

 private:
  Params params_;
};

void register_all(hal::Registrar& registrar) {
  static const core::EngineType type = [] {
    core::EngineType t;
    t.kind = "river";
    t.summary = "Wheels roll without slip on rafts that drift with the water; nothing collides.";
    t.read = [](const core::Element& element, core::Problems& problems) -> std::shared_ptr<const void> {
      return std::make_shared<Params>(
          core::read_settings<Params>(element, problems, {"id", "regions"}, {"boundaries"}));
    };
    t.describe = [](hal::ParamVisitor& v) { Params{}.describe(v); };
    t.make_solver = [](const std::shared_ptr<const void>& params, const core::SpaceStores&, const core::Region&,
                       double) -> std::unique_ptr<core::Solver> {
      return std::make_unique<River>(*static_cast<const Params*>(params.get()));
    };
    t.make = &core::make_solvers;
    return t;
  }();
  core::register_engine(registrar, type);
}

}  // namespace

TANDEM_PLUGIN(register_all)

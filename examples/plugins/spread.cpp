// An observer: looks at the world after every tick and writes how far the robots are spread.
#include <cmath>
#include <optional>
#include <stdexcept>

#include "core/record/observer.hpp"
#include "hal/elementary.hpp"
#include "hal/output_file.hpp"
#include "hal/plugin.hpp"
#include "hal/unit.hpp"

namespace {

using namespace tandem;

class Spread final : public core::Observer {
 public:
  struct Params {
    std::string path;
    std::int64_t every = 1;
    void describe(hal::ParamVisitor& v) {
      v.text("path", path, "CSV file to write.");
      v.integer("every", every, {1, 1e9}, "Ticks between rows.");
    }
  };
  Spread(const Params& params, const core::Observation&) : every_(params.every) {
    auto opened = hal::OutputFile::open(params.path, "spread");
    if (!opened.ok()) throw std::runtime_error(opened.error().message);
    file_ = std::move(opened).value();
    text_ = "tick,robots,spread_m\n";
  }

  hal::Status observe(const core::Observation& now) override {
    if (now.tick % every_ != 0) return {};
    const std::size_t robots = now.space.robot_count();
    double x_m = 0.0, y_m = 0.0, spread_m = 0.0;
    for (std::size_t i = 0; i < robots; ++i) {
      const core::Pose pose = now.space.pose(now.space.robot(i));
      x_m += pose.x_m / static_cast<double>(robots);
      y_m += pose.y_m / static_cast<double>(robots);
    }
    for (std::size_t i = 0; i < robots; ++i) {
      const core::Pose pose = now.space.pose(now.space.robot(i));
      spread_m += hal::hypot(pose.x_m - x_m, pose.y_m - y_m) / static_cast<double>(robots);
    }
    text_ += std::to_string(now.tick) + "," + std::to_string(robots) + "," + hal::format_number(spread_m) + "\n";
    return text_.size() < 65536 ? hal::Status{} : flush();
  }

  hal::Status flush() override {
    const hal::Status written = file_->write(text_);
    text_.clear();
    return written;
  }

  hal::Status finish(const core::Observation&) override {
    const hal::Status written = flush();
    return written.ok() ? file_->commit() : written;
  }

 private:
  std::int64_t every_;
  std::optional<hal::OutputFile> file_;
  std::string text_;
};

void register_all(hal::Registrar& registrar) {
  static const core::ObserverType type = core::observer_type<Spread>("spread", "How far robots are spread, as CSV.");
  registrar.add(type);
}

}  // namespace

TANDEM_PLUGIN(register_all)

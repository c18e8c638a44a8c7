// A controller of ARGoS' as one of ours.
#pragma once
#include <memory>

#include "compat/argos3/control/kept.hpp"
#include "hal/controller.hpp"

namespace tandem::compat::argos3 {

/// Steps a controller of ARGoS'. It is never copied: such controllers hold pointers of their own.
class Adapter final : public hal::Controller {
 public:
  struct Params {
    const argos::tandem_detail::SRegistration* registration = nullptr;
    std::shared_ptr<ticpp::Element> node;  ///< <params>, which all robots of a configuration share
    void describe(hal::ParamVisitor& v);
  };

  /// Calls Init, or Reset of a controller that loop functions hold for this robot. @throws its exceptions
  Adapter(hal::Robot& robot, const Params& params);
  /// Calls Destroy, unless loop functions hold the controller; an exception of it goes to the log.
  ~Adapter() override;
  Adapter(const Adapter&) = delete;
  Adapter& operator=(const Adapter&) = delete;

  void step() override { kept_->step(); }
  /// Calls Reset.
  bool reset(hal::Robot& robot) override;

 private:
  std::shared_ptr<Kept> kept_;
};

}  // namespace tandem::compat::argos3

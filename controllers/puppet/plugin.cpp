#include "hal/plugin.hpp"

#include "controllers/puppet/eyebot_puppet.hpp"
#include "controllers/puppet/puppet.hpp"
#include "controllers/puppet/wheeled_puppet.hpp"

namespace {
void register_all(tandem::hal::Registrar& registrar) {
  registrar.add_controller<tandem::controllers::Puppet>(
      "puppet", "Takes every device and does nothing: its ports are driven from outside.");
  registrar.add_controller<tandem::controllers::FootbotPuppet>(
      "footbot_puppet", "Takes a foot-bot's devices and does nothing: its ports are driven from outside.");
  registrar.add_controller<tandem::controllers::ThymioPuppet>(
      "thymio_puppet", "Takes a Thymio's devices and does nothing: its ports are driven from outside.");
  registrar.add_controller<tandem::controllers::EyebotPuppet>(
      "eyebot_puppet", "Takes an eye-bot's devices and does nothing: its ports are driven from outside.");
}
}  // namespace

TANDEM_PLUGIN(register_all)

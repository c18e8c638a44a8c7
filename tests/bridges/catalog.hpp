// The catalog of bridges, for tests that reach robots without the program.
#pragma once
#include "bridges/epuck/register.hpp"
#include "bridges/eyebot/register.hpp"
#include "bridges/footbot/register.hpp"
#include "bridges/thymio/register.hpp"
#include "hal/catalog.hpp"
#include "hal/check.hpp"

namespace tandem::test {

inline const hal::Catalog& bridges() {
  static const hal::Catalog all = [] {
    hal::Catalog made;
    const hal::Status good = made.add_from("tests", [](hal::Registrar& r) {
      tandem::bridges::epuck::register_bridge(r);
      tandem::bridges::footbot::register_bridge(r);
      tandem::bridges::eyebot::register_bridge(r);
      tandem::bridges::thymio::register_bridge(r);
    });
    TANDEM_CHECK(good.ok(), good.error().message.c_str());
    return made;
  }();
  return all;
}

}  // namespace tandem::test

// Needs a symbol that nobody has.
extern "C" int nobody_has_this();
extern "C" __attribute__((visibility("default"))) int ask() {
  return nobody_has_this();
}

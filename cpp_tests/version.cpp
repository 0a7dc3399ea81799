// A host that was built for another ABI: refused before it calls anything.
#include "superdeform.h"
#undef SDEF_ABI_VERSION
#define SDEF_ABI_VERSION 4711
#include "superdeform.hpp"

#include "check.h"
#include <string>

static void another_version_is_refused_every_time() {
  for (int time = 0; time < 2; time++) {
    std::string said;
    try {
      superdeform::Character::create();
    } catch (const superdeform::Error &error) {
      said = error.what();
    }
    CHECK(said.find("4711") != std::string::npos && said.find("take both from one release") != std::string::npos);
  }
}

int main() {
  RUN(another_version_is_refused_every_time);
  return REPORT();
}

// The header in C++, linked with two units of C.
#include "superdeform.hpp"
#include "check.h"
#include "layout.inc"

extern "C" uint32_t version_of_one(void);
extern "C" uint32_t version_of_two(SdefError *error);

static_assert(std::is_standard_layout_v<SdefMesh> && std::is_trivially_copyable_v<SdefMesh>);
static_assert(!std::is_copy_constructible_v<superdeform::Character> && !std::is_copy_assignable_v<superdeform::Style>);
static_assert(std::is_nothrow_move_constructible_v<superdeform::Deformer>);
static_assert(sizeof(superdeform::Character) == sizeof(SdefCharacter));
static_assert(sizeof(superdeform::Options) == sizeof(SdefOptions));

static void all_units_mean_the_same() {
  SdefError error = SDEF_ERROR_INIT;
  error.status = 1;
  CHECK(version_of_one() == SDEF_ABI_VERSION);
  CHECK(version_of_two(&error) == SDEF_ABI_VERSION);
  CHECK(error.struct_size == sizeof error && error.status == SDEF_STATUS_OK && error.message[0] == 0);
}

int main() {
  RUN(all_units_mean_the_same);
  return REPORT();
}

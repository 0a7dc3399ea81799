// The header in another unit of C99, twice: what it defines must not meet itself.
#include <stdint.h>
#include "superdeform.h"
#include "superdeform.h"
#include "layout.inc"

uint32_t version_of_two(SdefError *error);
uint32_t version_of_two(SdefError *error) {
  SdefError made = SDEF_ERROR_INIT;
  *error = made;
  return SDEF_ABI_VERSION;
}

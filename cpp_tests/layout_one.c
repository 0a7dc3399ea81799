// The header in one unit of C99, first of all that it includes.
#include "superdeform.h"
#include "layout.inc"

uint32_t version_of_one(void);
uint32_t version_of_one(void) { return sdef_abi_version(); }

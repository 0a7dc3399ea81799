// Checks for tests in C and C++. A test is a function; main() runs all and ends with report().
#ifndef CHECK_H
#define CHECK_H

#include <stdio.h>
#include <stdlib.h>

static int check_failures = 0;

#define CHECK(condition)                                                                                               \
  do {                                                                                                                 \
    if (!(condition)) {                                                                                                \
      fprintf(stderr, "%s:%d: not so: %s\n", __FILE__, __LINE__, #condition);                                          \
      check_failures++;                                                                                                \
    }                                                                                                                  \
  } while (0)

// A call of the ABI and the status that it must give.
#define GIVES(status, call)                                                                                            \
  do {                                                                                                                 \
    SdefStatus check_status = (call);                                                                                  \
    if (check_status != (status)) {                                                                                    \
      fprintf(stderr, "%s:%d: %s gave %s, not %s\n", __FILE__, __LINE__, #call, sdef_status_name(check_status),        \
              sdef_status_name(status));                                                                               \
      check_failures++;                                                                                                \
    }                                                                                                                  \
  } while (0)

#define OK(call) GIVES(SDEF_STATUS_OK, call)

#define RUN(test)                                                                                                      \
  do {                                                                                                                 \
    int check_before = check_failures;                                                                                 \
    test();                                                                                                            \
    if (sdef_live_handles() != 0) {                                                                                    \
      fprintf(stderr, "%s left %lu handles\n", #test, (unsigned long)sdef_live_handles());                             \
      check_failures++;                                                                                                \
    }                                                                                                                  \
    printf("%s %s\n", check_failures == check_before ? "passed" : "FAILED", #test);                                    \
  } while (0)

#define REPORT() (check_failures == 0 ? EXIT_SUCCESS : EXIT_FAILURE)

#endif

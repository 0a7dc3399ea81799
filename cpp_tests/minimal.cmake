# examples/minimal.c on a character, and on nothing; the README shows it whole.
# cmake -DSOURCE=FOLDER -DRUNNER=COMMAND -DMINIMAL=PROGRAM -DCHECK=PROGRAM -DBEFORE=FILE.obj -P minimal.cmake
file(READ ${SOURCE}/examples/minimal.c program)
file(READ ${SOURCE}/README.md readme)
string(FIND "${readme}" "```c\n${program}```" place)
if(place EQUAL -1)
  message(SEND_ERROR "README.md does not show examples/minimal.c as it is: copy it there")
endif()

cmake_path(REPLACE_FILENAME BEFORE after.obj OUTPUT_VARIABLE after)
execute_process(COMMAND ${RUNNER} ${MINIMAL} INPUT_FILE ${BEFORE} OUTPUT_FILE ${after} COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${RUNNER} ${CHECK} ${BEFORE} ${after} COMMAND_ERROR_IS_FATAL ANY)

cmake_path(REPLACE_FILENAME BEFORE nothing.obj OUTPUT_VARIABLE nothing)
file(WRITE ${nothing} "")
execute_process(COMMAND ${RUNNER} ${MINIMAL} INPUT_FILE ${nothing} RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE said)
if(NOT code EQUAL 1 OR NOT out STREQUAL "" OR NOT said MATCHES "triangle")
  message(SEND_ERROR "an empty file: exit code ${code}, output \"${out}\", error \"${said}\"")
endif()
message("an empty file: ${said}")

# cmake -DPROGRAM=FILE -DROOM=NAME -DSPEC=WHICH -DSLOW=TAG -DTOGETHER=TAG -DAT_ONCE=COUNT
#       -DENVIRONMENT=TEXT -DOUTPUT=FILE -P list_cases.cmake
# Writes OUTPUT, which ctest reads: a test "ROOM: NAME" for each test case of PROGRAM, a program made
# with Catch2. SPEC chooses cases as on its command line. Cases with the tag SLOW are started first,
# so that none of them is left for the end. Cases with the tag TOGETHER are run by one process. If
# AT_ONCE is above 1, one process runs so many of the cases that are not SLOW.
# Catch2's own catch_discover_tests splits names at semicolons.
cmake_minimum_required(VERSION 3.25)

# list_cases(SPEC RESULT): names, with what CMake's lists cannot hold written as <words>.
function(list_cases spec result)
  execute_process(COMMAND ${PROGRAM} ${spec} --list-test-names-only OUTPUT_VARIABLE names)
  string(REPLACE ";" "<semicolon>" names "${names}")
  string(REPLACE "[" "<open>" names "${names}")
  string(REPLACE "]" "<close>" names "${names}")
  string(REPLACE "\n" ";" names "${names}")
  list(REMOVE_ITEM names "")
  set(${result} "${names}" PARENT_SCOPE)
endfunction()

function(as_written name result)
  string(REPLACE "<semicolon>" ";" name "${name}")
  string(REPLACE "<open>" "[" name "${name}")
  string(REPLACE "<close>" "]" name "${name}")
  set(${result} "${name}" PARENT_SCOPE)
endfunction()

# as_spec(NAME RESULT): a name, with a backslash before what has a meaning in a choice of tests.
function(as_spec name result)
  string(REPLACE "\\" "\\\\" spec "${name}")
  string(REPLACE "\"" "\\\"" spec "${spec}")
  string(REPLACE "," "\\," spec "${spec}")
  string(REPLACE "[" "\\[" spec "${spec}")
  string(REPLACE "]" "\\]" spec "${spec}")
  set(${result} "${spec}" PARENT_SCOPE)
endfunction()

list_cases("${SPEC}" cases)
if(NOT cases)
  message(FATAL_ERROR "${PROGRAM} lists no test case")
endif()
set(slow "")
if(SLOW)
  list_cases("${SPEC}${SLOW}" slow)
endif()
set(together "")
if(TOGETHER)
  list_cases("${SPEC}${TOGETHER}" together)
  list(REMOVE_ITEM cases ${together})
endif()

set(text "")
# add_case(NAME COMMAND COST)
function(add_case name command cost)
  string(APPEND text "add_test([==[${ROOM}: ${name}]==] ${command})\n"
         "set_tests_properties([==[${ROOM}: ${name}]==] PROPERTIES LABELS ${ROOM} COST ${cost}")
  if(ENVIRONMENT)
    string(APPEND text " ENVIRONMENT [==[${ENVIRONMENT}]==]")
  endif()
  set(text "${text})\n" PARENT_SCOPE)
endfunction()

if(together)
  add_case("all of ${TOGETHER}" "[==[${PROGRAM}]==] [==[${SPEC}${TOGETHER}]==] --warn NoTests" 100)
endif()

# Cases of one process: a file with a choice of one case in each line, see tests/run_cases.sh.
set(group "")
set(group_size 0)
set(groups 0)
macro(end_group)
  if(group_size GREATER 0)
    math(EXPR groups "${groups} + 1")
    set(file ${OUTPUT}.${groups}.txt)
    file(WRITE ${file} "${group}")
    add_case("${group_size} cases from '${first}' on"
             "bash [==[${CMAKE_CURRENT_LIST_DIR}/../tests/run_cases.sh]==] [==[${PROGRAM}]==] [==[${file}]==]" 10)
    set(group "")
    set(group_size 0)
  endif()
endmacro()

foreach(case ${cases})
  as_written("${case}" name)
  as_spec("${name}" spec)
  if(case IN_LIST slow)
    add_case("${name}" "[==[${PROGRAM}]==] [==[${spec}]==] --warn NoTests" 50)
  elseif(AT_ONCE GREATER 1)
    if(group_size EQUAL 0)
      set(first "${name}")
    endif()
    string(APPEND group "${spec}\n")
    math(EXPR group_size "${group_size} + 1")
    if(group_size EQUAL AT_ONCE)
      end_group()
    endif()
  else()
    add_case("${name}" "[==[${PROGRAM}]==] [==[${spec}]==] --warn NoTests" 1)
  endif()
endforeach()
end_group()
file(WRITE ${OUTPUT} "${text}")

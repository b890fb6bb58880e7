# Unity, the test framework: adds the library `unity`, or none and sets MCTAU_HAVE_UNITY to 0.
#
# Looked for in this order; nothing of it is committed, and only the API of 2.5.1 is used:
#   1. -DUNITY_SOURCE_DIR=...        Unity's source, its root or its src/
#   2. find_package(unity)           when a test with doubles links
#   3. build/unity                   fetched before, by any preset
#   4. the official release archive  v2.6.1, checked against its hash
#   5. Debian's source of ntpsec     which carries Unity 2.5.1; for networks that see Debian alone
set(UNITY_SOURCE_DIR "" CACHE PATH "Unity's source; empty to find it")
set(unity_fetched ${PROJECT_SOURCE_DIR}/build/unity)
set(MCTAU_HAVE_UNITY 1)

# Adds `unity` from the folder that holds unity.c; leaves it unadded when the folder does not.
function(mctau_unity_from folder)
    foreach(place ${folder} ${folder}/src)
        if(NOT TARGET unity AND EXISTS ${place}/unity.c AND EXISTS ${place}/unity.h)
            message(STATUS "mctau: Unity from ${place}")
            add_library(unity STATIC ${place}/unity.c)
            target_include_directories(unity SYSTEM PUBLIC ${place})
            target_compile_definitions(unity PUBLIC UNITY_INCLUDE_DOUBLE)
            target_compile_options(unity PRIVATE -w)
        endif()
    endforeach()
endfunction()

function(mctau_unity_installed)
    find_package(unity QUIET)
    if(NOT TARGET unity::framework)
        return()
    endif()
    set(probe ${PROJECT_BINARY_DIR}/unity_probe.c)
    file(WRITE ${probe} "#define UNITY_INCLUDE_DOUBLE\n#include <unity.h>\n"
        "void setUp(void) {}\nvoid tearDown(void) {}\n"
        "int main(void) { UNITY_BEGIN(); TEST_ASSERT_DOUBLE_WITHIN(0.1, 1.0, 1.05); return UNITY_END(); }\n")
    try_compile(MCTAU_UNITY_HAS_DOUBLE ${PROJECT_BINARY_DIR}/unity_probe ${probe}
        LINK_LIBRARIES unity::framework)
    if(MCTAU_UNITY_HAS_DOUBLE)
        message(STATUS "mctau: Unity from find_package")
        add_library(unity INTERFACE)
        target_link_libraries(unity INTERFACE unity::framework)
        target_compile_definitions(unity INTERFACE UNITY_INCLUDE_DOUBLE)
    endif()
endfunction()

function(mctau_unity_download)
    set(archive ${PROJECT_BINARY_DIR}/unity.tar.gz)
    file(DOWNLOAD https://github.com/ThrowTheSwitch/Unity/archive/refs/tags/v2.6.1.tar.gz ${archive}
        STATUS status TIMEOUT 60 INACTIVITY_TIMEOUT 10)
    list(GET status 0 error)
    if(NOT error)
        file(SHA256 ${archive} hash)
        if(hash STREQUAL "b41a66d45a6b99758fb3202ace6178177014d52fc524bf1f72687d93e9867292")
            file(ARCHIVE_EXTRACT INPUT ${archive} DESTINATION ${PROJECT_BINARY_DIR}/unity_archive
                PATTERNS "*/src/unity*")
            file(GLOB source ${PROJECT_BINARY_DIR}/unity_archive/*/src)
            file(COPY ${source}/ DESTINATION ${unity_fetched})
            file(REMOVE_RECURSE ${PROJECT_BINARY_DIR}/unity_archive)
        else()
            message(STATUS "mctau: Unity's archive has the wrong hash, ${hash}; not used")
        endif()
    endif()
    file(REMOVE ${archive})
endfunction()

if(UNITY_SOURCE_DIR)
    mctau_unity_from(${UNITY_SOURCE_DIR})
    if(NOT TARGET unity)
        message(FATAL_ERROR "mctau: UNITY_SOURCE_DIR=${UNITY_SOURCE_DIR} holds no unity.c")
    endif()
else()
    mctau_unity_installed()
    mctau_unity_from(${unity_fetched})
    if(NOT TARGET unity)
        mctau_unity_download()
        mctau_unity_from(${unity_fetched})
    endif()
    if(NOT TARGET unity)
        execute_process(COMMAND bash ${PROJECT_SOURCE_DIR}/cmake/fetch_unity_debian ${unity_fetched}
            OUTPUT_VARIABLE said ERROR_VARIABLE said RESULT_VARIABLE error)
        if(error)
            message(STATUS "mctau: Unity from Debian's ntpsec: ${said}")
        endif()
        mctau_unity_from(${unity_fetched})
    endif()
endif()
if(NOT TARGET unity)
    set(MCTAU_HAVE_UNITY 0)
    set(advice "Unity not found; the C tests are skipped. Name a copy with -DUNITY_SOURCE_DIR=...")
    if(MCTAU_REQUIRE_ALL)
        message(FATAL_ERROR "mctau: ${advice}")
    endif()
    message(WARNING "mctau: ${advice}")
endif()

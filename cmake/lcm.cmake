# LCM, and the telemetry types generated from hal/lcm/types/*.lcm.
#
# Sets MCTAU_HAVE_LCM to 1 or 0, adds mctau_lcm_types (C) and mctau_lcm_python (in PROJECT_BINARY_DIR/python).
# Found by file and not by pkg-config: Debian's lcm.pc asks for GLib's headers, which lcm.h does not use.
# An LCM elsewhere (that of PyPI's wheel, for one) is named by -DCMAKE_PREFIX_PATH.
find_path(LCM_INCLUDE_DIR lcm/lcm.h)
find_library(LCM_LIBRARY lcm)
find_program(LCM_GEN lcm-gen)
mark_as_advanced(LCM_INCLUDE_DIR LCM_LIBRARY LCM_GEN)

if(LCM_INCLUDE_DIR AND LCM_LIBRARY AND LCM_GEN)
    set(MCTAU_HAVE_LCM 1)
else()
    set(MCTAU_HAVE_LCM 0)
    mctau_missing("LCM not found (tools/setup installs it); LCM telemetry and event log are left out")
    return()
endif()

add_library(mctau_lcm INTERFACE)
target_include_directories(mctau_lcm SYSTEM INTERFACE ${LCM_INCLUDE_DIR})
target_link_libraries(mctau_lcm INTERFACE ${LCM_LIBRARY})

file(GLOB type_files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/hal/lcm/types/*.lcm)
if(NOT type_files)
    add_library(mctau_lcm_types INTERFACE)
    target_link_libraries(mctau_lcm_types INTERFACE mctau_lcm)
    return()
endif()

# lcm-gen names its files after package and struct, so read those.
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${type_files})
set(types_dir ${PROJECT_BINARY_DIR}/lcm)
set(c_files "")
set(h_files "")
foreach(type_file IN LISTS type_files)
    file(STRINGS ${type_file} lines REGEX "^[ \t]*(package|struct)[ \t]+[A-Za-z0-9_]+")
    foreach(line IN LISTS lines)
        string(REGEX MATCH "(package|struct)[ \t]+([A-Za-z0-9_]+)" match "${line}")
        if(CMAKE_MATCH_1 STREQUAL "package")
            if(NOT CMAKE_MATCH_2 STREQUAL "mctau")
                message(FATAL_ERROR "mctau: ${type_file}: package is ${CMAKE_MATCH_2}; it must be mctau")
            endif()
        else()
            list(APPEND c_files ${types_dir}/mctau_${CMAKE_MATCH_2}.c)
            list(APPEND h_files ${types_dir}/mctau_${CMAKE_MATCH_2}.h)
        endif()
    endforeach()
endforeach()

file(MAKE_DIRECTORY ${types_dir} ${PROJECT_BINARY_DIR}/python)
add_custom_command(OUTPUT ${c_files} ${h_files}
    COMMAND ${LCM_GEN} -c --c-cpath ${types_dir} --c-hpath ${types_dir} ${type_files}
    DEPENDS ${type_files} COMMENT "LCM types for C" VERBATIM)
add_library(mctau_lcm_types STATIC ${c_files} ${h_files})
target_include_directories(mctau_lcm_types SYSTEM INTERFACE ${types_dir})
target_include_directories(mctau_lcm_types PRIVATE ${types_dir})
target_link_libraries(mctau_lcm_types PUBLIC mctau_lcm)
# The generated code reads doubles through int64_t pointers.
target_compile_options(mctau_lcm_types PRIVATE -fno-strict-aliasing -w)

# A type that is gone must not stay importable, so the package is written anew.
set(python_stamp ${PROJECT_BINARY_DIR}/python/mctau/__init__.py)
add_custom_command(OUTPUT ${python_stamp}
    COMMAND ${CMAKE_COMMAND} -E rm -rf ${PROJECT_BINARY_DIR}/python/mctau
    COMMAND ${LCM_GEN} -p --ppath ${PROJECT_BINARY_DIR}/python ${type_files}
    DEPENDS ${type_files} COMMENT "LCM types for Python" VERBATIM)
add_custom_target(mctau_lcm_python ALL DEPENDS ${python_stamp})

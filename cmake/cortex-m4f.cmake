# Cortex-M4F: arithmetic of float in hardware, of double in software.
set(MCTAU_CORTEX_M_FLAGS "-mcpu=cortex-m4 -mfpu=fpv4-sp-d16")
include(${CMAKE_CURRENT_LIST_DIR}/cortex-m.cmake)

/* What a Windows DLL needs to run on Windows' own C library (the UCRT) without one of the compiler's.
 *
 * Only for our cross-compilation, where building the compiler's runtime would take over a minute;
 * not among the FMU's sources.
 */
#include <stdarg.h>
#include <stddef.h>

/* UCRT's stdio.h implements vsnprintf by this call; 2 = _CRT_INTERNAL_PRINTF_STANDARD_SNPRINTF_BEHAVIOR. */
int __stdio_common_vsprintf(unsigned long long options, char *buffer, size_t count, const char *format, void *locale,
                            va_list values);

int vsnprintf(char *buffer, size_t count, const char *format, va_list values) {
    return __stdio_common_vsprintf(2, buffer, count, format, NULL, values);
}

/* The DLL has nothing to do when it is loaded or unloaded. */
int _DllMainCRTStartup(void *module, unsigned long reason, void *reserved) { return 1; }

#include "board.h"

#include "hal/cortex_m/processor.h"
#include "hal/cortex_m/start.h"
#include "registers.h"

enum { PATIENCE = 1000000 }; /* looks; at 16 MHz well above 0.1 s */

/* --- clock: RM0090, 7.2 and 7.3; wait states: 3.5.1 --- */

enum { CR_HSEON = 1 << 16, CR_HSERDY = 1 << 17, CR_PLLON = 1 << 24, CR_PLLRDY = 1 << 25 };
enum {
    PLLM = 8,
    PLLN = 336,
    PLLP_2 = 0 << 16,
    PLLSRC_HSE = 1 << 22,
    PLLQ = 7 << 24
}; /* 8 MHz / 8 * 336 / 2 */
enum { CFGR_SW_PLL = 2, CFGR_SWS = 3 << 2, CFGR_SWS_PLL = 2 << 2 };
enum { CFGR_PPRE1_4 = 5 << 10, CFGR_PPRE2_2 = 4 << 13 }; /* APB1 42 MHz, APB2 84 MHz, their highest */
enum { ACR_LATENCY_5 = 5, ACR_PRFTEN = 1 << 8, ACR_ICEN = 1 << 9, ACR_DCEN = 1 << 10 };

static bool becomes(const volatile uint32_t *place, uint32_t mask, uint32_t wanted)
{
    for (int i = 0; i < PATIENCE; i++) {
        if ((*place & mask) == wanted) {
            return true;
        }
    }
    return false;
}

static bool start_clock(void)
{
    RCC_CR |= CR_HSEON;
    if (!becomes(&RCC_CR, CR_HSERDY, CR_HSERDY)) {
        return false;
    }
    RCC_PLLCFGR = PLLM | PLLN << 6 | PLLP_2 | PLLSRC_HSE | PLLQ;
    RCC_CR |= CR_PLLON;
    if (!becomes(&RCC_CR, CR_PLLRDY, CR_PLLRDY)) {
        return false;
    }
    FLASH_ACR = ACR_LATENCY_5 | ACR_PRFTEN | ACR_ICEN | ACR_DCEN;
    if (!becomes(&FLASH_ACR, 7, ACR_LATENCY_5)) {
        return false;
    }
    RCC_CFGR = CFGR_SW_PLL | CFGR_PPRE1_4 | CFGR_PPRE2_2;
    return becomes(&RCC_CFGR, CFGR_SWS, CFGR_SWS_PLL);
}

/* --- pins: RM0090, 8.4; alternate function 9 is CAN (datasheet, table 9) --- */

enum { AHB1ENR_GPIOA = 1 << 0, AHB1ENR_GPIOD = 1 << 3, APB1ENR_CAN1 = 1 << 25 };
enum { CAN_RX = 0, CAN_TX = 1, LED_WELL = 12, LED_TICK = 13, BUTTON = 0 };
enum { MODE_OUTPUT = 1, MODE_ALTERNATE = 2, FUNCTION_CAN = 9, SPEED_HIGH = 2 };
enum { CAN1_TX_IRQ = 19, CAN1_RX0_IRQ = 20 };

static uint32_t with_mode(uint32_t modes, int pin, uint32_t mode)
{
    return (modes & ~(UINT32_C(3) << (2 * pin))) | mode << (2 * pin);
}

static void start_pins(void)
{
    RCC_AHB1ENR |= AHB1ENR_GPIOA | AHB1ENR_GPIOD;
    RCC_APB1ENR |= APB1ENR_CAN1;
    (void)RCC_APB1ENR; /* the clock is on two cycles later: errata sheet ES0182, delay after an enable */
    GPIOD_AFRL |= FUNCTION_CAN << (4 * CAN_RX) | FUNCTION_CAN << (4 * CAN_TX);
    GPIOD_OSPEEDR |= SPEED_HIGH << (2 * CAN_TX);
    uint32_t modes = GPIOD_MODER;
    modes = with_mode(modes, CAN_RX, MODE_ALTERNATE);
    modes = with_mode(modes, CAN_TX, MODE_ALTERNATE);
    modes = with_mode(modes, LED_WELL, MODE_OUTPUT);
    modes = with_mode(modes, LED_TICK, MODE_OUTPUT);
    GPIOD_MODER = modes;
}

bool mct_board_start(void)
{
    start_pins();
    const bool has_clock = start_clock();
    NVIC_ISER0 = UINT32_C(1) << CAN1_TX_IRQ | UINT32_C(1) << CAN1_RX0_IRQ;
    return has_clock;
}

void mct_board_show_well(bool is_well)
{
    GPIOD_BSRR = UINT32_C(1) << (is_well ? LED_WELL : LED_WELL + 16);
}

void mct_board_show_tick(void)
{
    const bool is_lit = (GPIOD_ODR >> LED_TICK & 1) != 0;
    GPIOD_BSRR = UINT32_C(1) << (is_lit ? LED_TICK + 16 : LED_TICK);
}

bool mct_board_button(void)
{
    return (GPIOA_IDR >> BUTTON & 1) != 0;
}

/* --- independent watchdog: RM0090, 21.3 and 21.4 --- */

enum { KEY_START = 0xCCCC, KEY_ACCESS = 0x5555, KEY_FEED = 0xAAAA };
enum { FASTEST_KHZ = 47, MOST_RELOAD = 0xFFF, MOST_PRESCALER = 6 };

bool mct_board_watchdog_start(uint32_t least_us)
{
    const uint64_t cycles = (uint64_t)least_us * FASTEST_KHZ / 1000 + 1;
    uint32_t prescaler = 0; /* divides by 4 << prescaler */
    while (prescaler < MOST_PRESCALER && cycles >> (2 + prescaler) > MOST_RELOAD - 1) {
        prescaler++;
    }
    const uint64_t reload = (cycles >> (2 + prescaler)) + 1;
    if (reload > MOST_RELOAD) {
        return false;
    }
    IWDG_KR = KEY_START; /* turns on its oscillator, too */
    IWDG_KR = KEY_ACCESS;
    IWDG_PR = prescaler;
    IWDG_RLR = (uint32_t)reload;
    const bool is_set = becomes(&IWDG_SR, 3, 0);
    IWDG_KR = KEY_FEED;
    return is_set;
}

void mct_board_watchdog_feed(void)
{
    IWDG_KR = KEY_FEED;
}

/* --- the end --- */

/* No command goes out any more: the drive's own watchdog takes the volts away; this chip's begins anew, disarmed. */
void mct_image_end(const char *said, int code)
{
    (void)said; /* for who looks with a debugger */
    (void)code;
    mct_interrupts_hold();
    mct_board_show_well(false);
    for (;;) {
    }
}

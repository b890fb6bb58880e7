/* The default scene swings up and balances although its parameters vary, with noise and a tick of latency. */
#include "support/scenes.h"
#include "support/swing_up.h"
#include "unity.h"

void setUp(void)
{
}

void tearDown(void)
{
}

static void test_variations_that_the_controller_does_not_know_swing_up_and_balance(void)
{
    check_variations(CART_POLE, false);
}

static void test_variations_that_the_controller_knows_swing_up_and_balance(void)
{
    check_variations(CART_POLE, true);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_variations_that_the_controller_does_not_know_swing_up_and_balance);
    RUN_TEST(test_variations_that_the_controller_knows_swing_up_and_balance);
    return UNITY_END();
}

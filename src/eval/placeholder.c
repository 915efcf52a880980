typedef int orl_placeholder;
